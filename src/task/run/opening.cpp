#include "task/run/opening.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/checksum.h"
#include "base/installed.h"
#include "base/regular_file.h"

namespace dihaptic::task {
namespace {

// tolerance for rounding errors, since times are sums of ticks [s]
constexpr double kTolerance = 1e-6;

constexpr int64_t kMostPicture = 200'000'000;  // [bytes]

/// Stores the checksum of a page's picture. Throws Error if the file cannot be read or is neither a
/// PNG nor a GIF file.
void note_checksum(PageSpec& page) {
    const std::string bytes = read_bytes(page.picture, kMostPicture);
    const bool is_png = bytes.starts_with("\x89PNG\r\n\x1a\n");
    if (!is_png && !bytes.starts_with("GIF87a") && !bytes.starts_with("GIF89a"))
        throw Error("is neither a PNG nor a GIF file",
                    "Convert it with an image editor; for an animated picture, convert a video: "
                    "ffmpeg -i video.mp4 picture.gif.");
    page.checksum = checksum_of(bytes);
}

}  // namespace

void find_pictures(Task& task, const std::string& folder, Diagnostics& diagnostics) {
    for (Block& block : task.blocks) {
        for (PageSpec& page : block.pages) {
            if (page.picture.empty()) continue;
            page.picture = named_in(folder, page.picture);
            std::error_code unreadable;
            if (!std::filesystem::is_regular_file(page.picture, unreadable)) {
                diagnostics.error(page.place, "picture",
                                  fmt::format("there is no file {}", page.picture),
                                  "Name a PNG or GIF file, relative to this one.");
                continue;
            }
            try {
                note_checksum(page);
            } catch (const Error& e) {
                const Problem& why = e.problems().front();
                diagnostics.error(page.place, "picture", page.picture + " " + why.what, why.remedy);
            }
        }
    }
}

double longest_opening(const TaskPlan& plan) noexcept {
    double longest = 0;
    for (const TaskPlan::Opening& opening : plan.openings) {
        double all = opening.rest;
        for (int i = 0; i < opening.pages; ++i)
            all += std::max(1.0, plan.pages[static_cast<size_t>(opening.first + i)].spec.lasts);
        longest = std::max(longest, all);
    }
    return longest;
}

bool Opening::over(const Trial& next, bool rests, char key, double now) noexcept {
    if (next.number == opened_) return true;
    if (on_ != next.number) {
        on_ = next.number;
        block_ = next.block;
        at_ = rests && of_block().rest > 0 ? -1 : 0;
        since_ = now;
        key = 0;  // ignore a key pressed before the page was shown
    }
    if (at_ < 0) {
        if (rest_left(now) > kTolerance) return false;
        at_ = 0;
        since_ = now;
        key = 0;
    }
    while (at_ < of_block().pages) {
        const PageSpec& page = plan_.pages[static_cast<size_t>(this->page())].spec;
        const bool pressed = key != 0 && (page.key.empty() || key == page.key.front());
        const bool ended = page.lasts > 0 && now - since_ >= page.lasts - kTolerance;
        if (!pressed && !ended) return false;
        ++at_;
        since_ = now;
        key = 0;
    }
    opened_ = next.number;
    on_ = 0;
    return true;
}

int Opening::page() const noexcept {
    return on_ != 0 && at_ >= 0 && at_ < of_block().pages ? of_block().first + at_ : -1;
}

double Opening::rest_left(double now) const noexcept {
    return on_ != 0 && at_ < 0 ? of_block().rest - (now - since_) : -1;
}

}  // namespace dihaptic::task
