#include "recording/remarks.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "base/regular_file.h"
#include "rows/row_file.h"

namespace dihaptic::recording {

void RemarksWriter::add(const Remark& remark) {
    if (!out_.is_open()) {
        out_.open(file_);
        out_ << "tick,time_s,trial,clock,note\n";
    }
    out_ << fmt::format("{},{:.6f},{},{},{}\n", remark.tick, remark.time, remark.trial,
                        remark.clock, to_csv(Table::Cell(remark.text)));
    out_.flush();
    if (out_.good()) return;
    ++lost_;
    out_.clear();
}

std::vector<Remark> read_remarks(const SessionFolder& folder) {
    const std::string file = folder.file("notes.csv");
    std::error_code unreadable;
    // the program may have been killed before it wrote the first line
    if (!is_there(file) || std::filesystem::file_size(file, unreadable) == 0) return {};
    std::vector<Remark> out;
    for (const Remark& remark : rows::RowFile<Remark>(file)) {
        // the last line may be incomplete if the program was killed
        if (remark.tick >= 0 && std::isfinite(remark.time) && !remark.text.empty())
            out.push_back(remark);
    }
    return out;
}

std::string describe(const Remark& remark) {
    const std::string trial = remark.trial > 0 ? fmt::format(", trial {}", remark.trial) : "";
    return fmt::format("{:.1f} s{}: {}", remark.time, trial, remark.text);
}

}  // namespace dihaptic::recording
