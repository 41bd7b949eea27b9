#include "recording/raw_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>

#include "base/disk.h"
#include "base/field_reader.h"
#include "base/field_writer.h"
#include "recording/frame_check.h"
#include "recording/schema.h"
#include "scene/names.h"

namespace dihaptic::recording {
namespace {

/// If the disk was busy, a waiting chunk is written once it reaches this length [bytes].
constexpr size_t kLongChunk = 8u << 20;

void write_all(int descriptor, const void* data, size_t size, const std::string& file) {
    const char* at = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t n = ::write(descriptor, at, size);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            throw Error({file, 0}, "", fmt::format("cannot be written: {}", std::strerror(errno)),
                        "Earlier data are kept: " + make_room(errno) +
                            ", then run 'dihaptic recover' on the session's folder.");
        }
        at += n;
        size -= static_cast<size_t>(n);
    }
}

/// Checks the setup, because its names become parts of file names and its counts become buffer
/// sizes.
void check_head(const LogHead& head, const std::string& file) {
    constexpr size_t kMost = 65535;  // counts of bodies are stored in two bytes
    const auto check = [&](const char* key, const std::vector<std::string>& names) {
        std::set<std::string> all;
        bool good = names.size() <= kMost;
        for (const std::string& name : names) {
            good = good && !name.empty() && name.size() <= scene::kLongestName && name != "." &&
                   all.insert(name).second && std::none_of(name.begin(), name.end(), [](char c) {
                       return c == '/' || static_cast<unsigned char>(c) < ' ';
                   });
        }
        if (good) return;
        throw Error({file, 0}, key,
                    "are not valid for a session: there are too many, or they are not names",
                    "Replace it with a backup.");
    };
    check("fingers", head.fingers);
    check("bodies", head.bodies);
    check("joints", head.joints);
    check("devices", head.turning_fingers());
    if (head.devices.size() <= head.fingers.size()) return;
    throw Error({file, 0}, "devices", "are more than the fingers that they hold",
                "Replace it with a backup.");
}

}  // namespace

RawLogWriter::RawLogWriter(const std::string& file, const LogHead& head) : file_(file) {
    descriptor_ = Descriptor(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
    if (!descriptor_) {
        throw Error({file, 0}, "", fmt::format("cannot be created: {}", std::strerror(errno)),
                    "Choose another folder, with --out or under File > Where sessions go in the "
                    "window.");
    }
    Node text = write_fields(head);
    text.set("schema", Node::of(schema()));
    const std::string yaml = to_yaml(text);
    const auto bytes = std::as_bytes(std::span(yaml));
    session_ = session_of(bytes);
    write_all(descriptor_.get(), kFirstLine.data(), kFirstLine.size(), file_);
    write_chunk(kHead, bytes);
}

RawLogWriter::~RawLogWriter() {
    if (!descriptor_) return;
    try {
        flush();
    } catch (const Error&) {
        // the disk is full: flush() has already reported it to a caller that could act on it
    }
}

void RawLogWriter::add(std::span<const std::byte> frame) {
    packer_.add(frame);
    ++frames_;
    if (packer_.size() >= kLongChunk) flush();
}

void RawLogWriter::flush() {
    if (packer_.size() > 0) write_chunk(kPacked, packer_.pack());
}

void RawLogWriter::sync() const {
    sync_to_disk(descriptor_.get(), file_);
}

void RawLogWriter::finish() {
    flush();
    write_chunk(kDone, std::as_bytes(std::span(&frames_, 1)));
    sync();
    descriptor_.close();
}

void RawLogWriter::write_chunk(uint32_t kind, std::span<const std::byte> payload) {
    ChunkHeader header{kind, static_cast<uint32_t>(payload.size()), session_, number_++, 0};
    header.checksum = checksum(header, payload);
    write_all(descriptor_.get(), &header, sizeof(header), file_);
    write_all(descriptor_.get(), payload.data(), payload.size(), file_);
}

RawLogReader::RawLogReader(const std::string& file) : file_(file), chunks_(file) {
    read_head();
    check_head(head_, file);
    layout_ = head_.layout();
}

void RawLogReader::read_head() {
    const std::vector<std::byte>& bytes = chunks_.head();
    const Node text = parse_yaml({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file_,
                                 Words::mended);
    const Node* const schema = text.find("schema");
    decoder_.emplace(schema == nullptr ? "" : schema->scalar, file_);
    health_.not_recorded = decoder_->missing();
    health_.passed_over = decoder_->unknown();
    Node fields = text;
    std::erase_if(fields.entries, [](const auto& entry) { return entry.key == "schema"; });
    Diagnostics diagnostics(UnknownKeys::are_left_out);
    read_fields(head_, fields, diagnostics);
    diagnostics.throw_if_errors();
}

void RawLogReader::go_to(const ChunkPlace& place, bool follows) {
    if (!follows) {
        forget_bodies(true);
        health_ = {};
    }
    damaged_ = gone_ = read_bytes_ = 0;
    rest_ = {};
    chunks_.go_to(place);
    read_chunk();
    ended_ = true;
}

const LogHealth& RawLogReader::read_to_end() {
    while (next() != nullptr) continue;
    return health_;
}

/// Reads the records of the next chunk; returns false at the end of the log.
bool RawLogReader::read_chunk() {
    const Chunk* chunk = chunks_.next();
    if (chunk == nullptr) {
        note_end();
        return false;
    }
    damaged_ += chunk->damaged;
    gone_ += chunk->missing;
    using Place = Chunk::Place;
    if (chunk->place == Place::after_end) {
        health_.note(Stray::Kind::after_end, 1, damaged_ + chunk->bytes);
        damaged_ = 0;
    } else if (chunk->place == Place::foreign || chunk->kind == kHead) {
        // only in version 1, whose chunks name no session, can a second head appear here
        const bool doubled = chunk->place == Place::doubled;
        health_.note(doubled ? Stray::Kind::doubled : Stray::Kind::foreign, 1, chunk->bytes);
    } else if (chunk->place == Place::doubled) {
        health_.note(Stray::Kind::doubled, 1, chunk->bytes);
    } else {
        if (chunk->place == Place::moved) health_.note(Stray::Kind::moved, 1, chunk->bytes);
        if (chunk->kind == kDone) {
            note_done(*chunk);
        } else {
            begin_records(*chunk);
        }
    }
    return true;
}

void RawLogReader::begin_records(const Chunk& chunk) {
    std::optional<std::span<const std::byte>> records = chunk.payload;
    if (chunk.kind == kPacked) records = unpacker_.unpack(chunk.payload);
    if (records) {
        rest_ = *records;
        read_bytes_ += chunk.bytes;
    } else {
        health_.note(Stray::Kind::no_frame, 1, chunk.bytes);
        forget_bodies(true);
    }
}

void RawLogReader::note_done(const Chunk& chunk) {
    if (chunk.payload.size() != sizeof(health_.written)) {
        health_.note(Stray::Kind::no_frame, 1, chunk.bytes);
    } else {
        std::memcpy(&health_.written, chunk.payload.data(), chunk.payload.size());
    }
    health_.complete = true;
    health_.tail_bytes = damaged_;
    health_.tail_ticks = ticks_in(damaged_);
    health_.tail_chunks = gone_;
    damaged_ = gone_ = 0;
}

void RawLogReader::note_end() {
    ended_ = true;
    const int64_t bytes = damaged_ + chunks_.tail();
    if (bytes == 0) return;
    if (health_.complete) {
        health_.note(Stray::Kind::after_end, 0, bytes);
        return;
    }
    int64_t wanted = 0;
    health_.unfinished = chunks_.tail_is_unfinished(wanted);
    health_.tail_bytes = bytes;
    health_.tail_ticks = ticks_in(wanted > 0 ? wanted : bytes);  // the intended size, if known
}

int64_t RawLogReader::ticks_in(int64_t bytes) const {
    return read_bytes_ == 0 ? 0 : bytes * health_.frames / read_bytes_;
}

/// Sets unknown values of bodies to NaN, either for all bodies or only for the bodies that are not
/// in this frame.
void RawLogReader::forget_bodies(bool all) {
    const Vec3 unknown = Vec3::Constant(kUnmeasured);
    for (size_t i = 0; i < frame_.bodies.size(); ++i) {
        if (!all &&
            std::find(frame_.changed.begin(), frame_.changed.end(), i) != frame_.changed.end())
            continue;
        frame::BodyFrame& body = frame_.bodies[i];
        body = {{Quat(Eigen::Vector4d::Constant(kUnmeasured)), unknown}, unknown, unknown};
    }
}

void RawLogReader::note_frame() {
    const Time period = from_seconds(head_.tick);
    const Time last = health_.frames > 0 ? health_.last_time : -period;
    const int64_t missing = frame_.sequence - health_.last_tick - 1;
    // devices that set the pace have their own period, so the time is rounded to whole ticks
    const int64_t periods = (frame_.time - last + period / 2) / period;
    health_.left_out += std::max<int64_t>(0, periods - missing - 1);
    if (missing > 0) {
        health_.gaps.push_back(
            {health_.last_tick + 1, missing, health_.last_time, frame_.time, damaged_, gone_});
        forget_bodies(false);  // bodies that are not in this frame may have moved
    } else if (damaged_ > 0) {
        health_.note(Stray::Kind::no_chunk, 0, damaged_);
    }
    damaged_ = gone_ = 0;
    ++health_.frames;
    health_.last_tick = frame_.sequence;
    health_.last_time = frame_.time;
}

/// Reads the next record. Returns false unless the record is a frame of this session that can
/// follow the previous frame.
bool RawLogReader::read_frame() {
    uint32_t length = 0;
    if (rest_.size() >= sizeof(length)) std::memcpy(&length, rest_.data(), sizeof(length));
    const bool fits = rest_.size() >= sizeof(length) + length;
    if (!fits || !decoder_->decode(rest_.subspan(sizeof(length), length), layout_, frame_) ||
        !is_possible(frame_, layout_)) {
        health_.note(Stray::Kind::no_frame, 1, static_cast<int64_t>(rest_.size()));
        rest_ = {};
        return false;
    }
    rest_ = rest_.subspan(sizeof(length) + length);
    if (health_.frames == 0 ||
        (frame_.sequence > health_.last_tick && frame_.time > health_.last_time))
        return true;
    health_.note(Stray::Kind::backwards, 1, static_cast<int64_t>(sizeof(length) + length));
    return false;
}

const frame::Frame* RawLogReader::next() {
    while (true) {
        while (rest_.empty()) {
            if (ended_ || !read_chunk()) return nullptr;
        }
        if (!read_frame()) {
            forget_bodies(true);
            continue;
        }
        note_frame();
        return &frame_;
    }
}

}  // namespace dihaptic::recording
