// Reads a log that was overwritten in places with nonsense: once as it is, and once with corrected
// checksums, because a fuzzer would never find nonsense with a correct checksum. The input is a
// list of edits of five bytes each or, if it begins with the letter D, a log itself.
#include "recording/raw_log.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <optional>
#include <vector>

#include "recording/chunk.h"
#include "testing/fuzz.h"
#include "testing/log_chunks.h"

namespace {

using namespace dihaptic;
using Bytes = std::vector<uint8_t>;

/// Returns a log with five short chunks, three bodies and two fingers, one of which has a device
/// that measures orientation.
Bytes written() {
    const TemporaryFolder folder;
    const std::string file = folder.file("raw.log");
    recording::LogHead head;
    head.fingers = {"thumb", "index"};
    head.bodies = {"table", "block", "ball"};
    head.devices.resize(2);
    head.devices[0].finger = "thumb";
    head.devices[1].finger = "index";
    head.devices[1].measures_orientation = true;
    recording::RawLogWriter writer(file, head);
    std::vector<std::byte> bytes(recording::most_bytes(head.layout(), 8));
    for (int64_t i = 0; i < 10; ++i) {
        frame::Frame frame;
        frame.sequence = i;
        frame.time = i * std::chrono::milliseconds(1);
        frame.fingers.resize(2);
        frame.bodies.resize(3);
        frame.turns.resize(1);
        frame.changed = i == 0 ? std::vector<uint16_t>{0, 1, 2} : std::vector<uint16_t>{2};
        frame.contacts.resize(static_cast<size_t>(i % 3));
        writer.add(std::span(bytes).first(recording::encode(frame, bytes)));
        if (i % 2 == 1) writer.flush();
    }
    writer.finish();
    recording::RawLogReader reader(file);
    for (int i = 0; i < 10; ++i) {
        if (reader.next() == nullptr) std::abort();  // the log must be intact before it is edited
    }
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Returns the same log with unpacked records, so that edits can change the values in a frame.
Bytes unpacked(const Bytes& log) {
    const auto chunks = testing::take_apart({log.begin(), log.end()});
    const testing::Bytes out = testing::put_together(chunks);
    return {out.begin(), out.end()};
}

/// Applies an edit at the position given by bytes 1 and 2 of the edit, with its bytes 3 and 4 as
/// arguments.
enum class Edit { set_byte, set_word, cut_off, remove, repeat };

void apply(std::span<const uint8_t> edit, Bytes& log) {
    if (log.empty()) return;
    const auto word = [&](size_t i) { return static_cast<size_t>(edit[i] | edit[i + 1] << 8); };
    const size_t at = word(1) % log.size();
    const size_t count = std::min(word(3), log.size() - at);
    const auto from = log.begin() + static_cast<std::ptrdiff_t>(at);
    const auto to = from + static_cast<std::ptrdiff_t>(count);
    switch (static_cast<Edit>(edit[0] % 5)) {
        case Edit::set_byte:
            log[at] = edit[3];
            break;
        case Edit::set_word:
            for (size_t i = at; i < std::min(at + 4, log.size()); ++i) log[i] = edit[3];
            break;
        case Edit::cut_off:
            log.resize(at);
            break;
        case Edit::remove:
            log.erase(from, to);
            break;
        case Edit::repeat: {
            const Bytes part(from, to);
            log.insert(from, part.begin(), part.end());
            break;
        }
    }
}

/// Corrects the checksums, and also the session of each chunk, from the first chunk on for as long
/// as chunks are adjacent.
void make_checksums_right(Bytes& log) {
    using recording::ChunkHeader;
    std::optional<uint64_t> session;
    for (size_t at = recording::kFirstLine.size(); at + sizeof(ChunkHeader) <= log.size();) {
        ChunkHeader header;
        std::memcpy(&header, &log[at], sizeof header);
        const auto rest = std::as_bytes(std::span(log)).subspan(at + sizeof header);
        if (header.size > rest.size()) return;
        const auto payload = rest.first(header.size);
        if (!session) session = recording::session_of(payload);
        header.session = *session;
        header.checksum = recording::checksum(header, payload);
        std::memcpy(&log[at], &header, sizeof header);
        at += sizeof header + payload.size();
    }
}

void read(const Bytes& log) {
    try {
        recording::RawLogReader reader(testing::as_file(log, "raw.log"));
        while (reader.next() != nullptr) {
        }
        (void)reader.share();
    } catch (const Error&) {
        // an error with file, line and remedy is the expected result
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static const Bytes packed = written();
    static const Bytes plain = unpacked(packed);
    constexpr size_t kMostEdits = 64;
    const bool is_log = size > 0 && data[0] == 'D';
    for (const Bytes& whole : {packed, plain}) {
        Bytes log = is_log ? Bytes(data, data + size) : whole;
        for (size_t i = 0; !is_log && i + 5 <= size && i < 5 * kMostEdits; i += 5)
            apply({data + i, 5}, log);
        read(log);
        make_checksums_right(log);
        read(log);
    }
    return 0;
}
