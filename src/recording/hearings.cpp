#include "recording/hearings.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "base/regular_file.h"
#include "rows/row_file.h"

namespace dihaptic::recording {

void HearingsWriter::add(const Hearing& hearing) {
    if (!out_.is_open()) {
        out_.open(file_);
        out_ << "tick,sound,asked_s,heard_s\n";
    }
    out_ << fmt::format("{},{},{:.6f},{:.6f}\n", hearing.tick, to_csv(Table::Cell(hearing.sound)),
                        hearing.asked, hearing.heard);
}

std::vector<Hearing> read_hearings(const SessionFolder& folder) {
    const std::string file = folder.file("heard.csv");
    std::error_code unreadable;
    // the program may have been killed before it wrote the first line
    if (!is_there(file) || std::filesystem::file_size(file, unreadable) == 0) return {};
    std::vector<Hearing> out;
    for (const Hearing& hearing : rows::RowFile<Hearing>(file)) {
        // the last line may be incomplete if the program was killed
        if (hearing.tick >= 0 && std::isfinite(hearing.heard)) out.push_back(hearing);
    }
    return out;
}

}  // namespace dihaptic::recording
