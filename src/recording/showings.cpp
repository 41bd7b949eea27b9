#include "recording/showings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/regular_file.h"
#include "rows/row_file.h"

namespace dihaptic::recording {

void ShowingsWriter::add(const Showing& showing) {
    if (!out_.is_open()) {
        out_.open(file_);
        out_ << "tick,shown_s\n";
    }
    out_ << fmt::format("{},{:.6f}\n", showing.tick, showing.time);
}

Showings::Showings(const SessionFolder& folder) {
    const std::string file = folder.file("shown.csv");
    std::error_code unreadable;
    // the program may have been killed before it wrote the first line
    if (!is_there(file) || std::filesystem::file_size(file, unreadable) == 0) return;
    for (const Showing& showing : rows::RowFile<Showing>(file)) {
        // the last line may be incomplete if the program was killed
        if (showing.tick >= 0 && std::isfinite(showing.time)) showings_.push_back(showing);
    }
}

double Showings::onset(int64_t tick, double time, int64_t until) const {
    const auto first =
        std::lower_bound(showings_.begin(), showings_.end(), tick,
                         [](const Showing& showing, int64_t t) { return showing.tick < t; });
    if (first == showings_.end() || first->tick >= until || first->time - time > kSeen)
        return kUnmeasured;
    return first->time;
}

}  // namespace dihaptic::recording
