#include "recording/raw_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/field_reader.h"
#include "base/field_writer.h"

namespace dihaptic::recording {
namespace {

constexpr char kMagic[] = "DIHAPTIC LOG 1\n";
constexpr size_t kMagicSize = sizeof(kMagic) - 1;
constexpr uint32_t kHead = 0x44414548;  // "HEAD"
constexpr uint32_t kData = 0x41544144;  // "DATA"
constexpr uint32_t kDone = 0x454E4F44;  // "DONE"
constexpr uint32_t kMostPayload = 1u << 28;

struct ChunkHeader {
    uint32_t kind;
    uint32_t size;
    uint32_t checksum;
};

uint32_t checksum(uint32_t kind, std::span<const std::byte> payload) {
    const auto size = static_cast<uint32_t>(payload.size());
    uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(&kind), sizeof(kind));
    crc = crc32_z(crc, reinterpret_cast<const Bytef*>(&size), sizeof(size));
    return static_cast<uint32_t>(
        crc32_z(crc, reinterpret_cast<const Bytef*>(payload.data()), payload.size()));
}

void write_all(int descriptor, const void* data, size_t size, const std::string& file) {
    const char* at = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t n = ::write(descriptor, at, size);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            throw Error({file, 0}, "", fmt::format("cannot be written: {}", std::strerror(errno)),
                        "What was written before is kept: free some space, then run 'dihaptic "
                        "recover' on the "
                        "session's folder.");
        }
        at += n;
        size -= static_cast<size_t>(n);
    }
}

}  // namespace

RawLogWriter::RawLogWriter(const std::string& file, const LogHead& head) : file_(file) {
    descriptor_ = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (descriptor_ < 0) {
        throw Error({file, 0}, "", fmt::format("cannot be created: {}", std::strerror(errno)),
                    "Choose another folder with --out.");
    }
    Node text = write_fields(head);
    text.set("schema", Node::of(schema()));
    const std::string yaml = to_yaml(text);
    write_all(descriptor_, kMagic, kMagicSize, file_);
    write_chunk(kHead, std::as_bytes(std::span(yaml)));
}

RawLogWriter::~RawLogWriter() {
    if (descriptor_ < 0) return;
    try {
        flush();
    } catch (const Error&) {
        // the disk is full: flush() has said so before, to someone who could act
    }
    ::close(descriptor_);
}

void RawLogWriter::add(std::span<const std::byte> frame) {
    const auto length = static_cast<uint32_t>(frame.size());
    const auto bytes = std::as_bytes(std::span(&length, 1));
    chunk_.insert(chunk_.end(), bytes.begin(), bytes.end());
    chunk_.insert(chunk_.end(), frame.begin(), frame.end());
    ++frames_;
}

void RawLogWriter::flush() {
    if (chunk_.empty()) return;
    write_chunk(kData, chunk_);
    chunk_.clear();
}

void RawLogWriter::finish() {
    flush();
    write_chunk(kDone, std::as_bytes(std::span(&frames_, 1)));
    ::fsync(descriptor_);
    ::close(descriptor_);
    descriptor_ = -1;
}

void RawLogWriter::write_chunk(uint32_t kind, std::span<const std::byte> payload) {
    const ChunkHeader header{kind, static_cast<uint32_t>(payload.size()), checksum(kind, payload)};
    write_all(descriptor_, &header, sizeof(header), file_);
    write_all(descriptor_, payload.data(), payload.size(), file_);
}

RawLogReader::RawLogReader(const std::string& file) : file_(file), in_(file, std::ios::binary) {
    const std::string remedy = "Give a session's folder, or its raw.log.";
    if (!in_) throw Error({file, 0}, "", "cannot be read", remedy);
    in_.seekg(0, std::ios::end);
    size_ = in_.tellg();
    in_.seekg(0);
    char magic[kMagicSize] = {};
    in_.read(magic, kMagicSize);
    if (!in_ || std::memcmp(magic, kMagic, kMagicSize) != 0)
        throw Error({file, 0}, "", "is not a log of Dihaptic", remedy);
    end_ = kMagicSize;
    if (!read_chunk_at(end_) || kind_ != kHead)
        throw Error({file, 0}, "", "has no readable head", "Nothing of it can be recovered.");
    const Node text =
        parse_yaml({reinterpret_cast<const char*>(chunk_.data()), chunk_.size()}, file);
    const Node* recorded = text.find("schema");
    if (recorded == nullptr || recorded->scalar != schema()) {
        throw Error({file, 0}, "",
                    "was written by another version of Dihaptic, whose frames differ",
                    "Read it with that version; session.yaml names it.");
    }
    Node fields = text;
    std::erase_if(fields.entries, [](const auto& entry) { return entry.key == "schema"; });
    Diagnostics diagnostics;
    read_fields(head_, fields, diagnostics);
    diagnostics.throw_if_errors();
    chunk_.clear();
}

bool RawLogReader::read_chunk_at(int64_t at) {
    ChunkHeader header{};
    in_.clear();
    in_.seekg(at);
    in_.read(reinterpret_cast<char*>(&header), sizeof(header));
    const int64_t left = size_ - at - static_cast<int64_t>(sizeof(header));
    if (!in_.good() || header.size > kMostPayload || header.size > left) return false;
    chunk_.resize(header.size);
    at_ = 0;
    in_.read(reinterpret_cast<char*>(chunk_.data()), header.size);
    if (in_.fail() || checksum(header.kind, chunk_) != header.checksum) {
        chunk_.clear();
        return false;
    }
    kind_ = header.kind;
    skipped_ += at - end_;
    end_ = at + static_cast<int64_t>(sizeof(header)) + header.size;
    return true;
}

int64_t RawLogReader::find_kind(int64_t from) {
    constexpr int64_t kBlock = 1 << 16;
    constexpr int64_t kOverlap = sizeof(uint32_t) - 1;  // a kind may lie across two blocks
    std::string block;
    for (; from + kOverlap < size_; from += kBlock - kOverlap) {
        block.resize(static_cast<size_t>(std::min(kBlock, size_ - from)));
        in_.clear();
        in_.seekg(from);
        in_.read(block.data(), static_cast<std::streamsize>(block.size()));
        size_t found = std::string::npos;
        for (const uint32_t kind : {kData, kDone}) {
            const std::string_view letters(reinterpret_cast<const char*>(&kind), sizeof(kind));
            found = std::min(found, block.find(letters));
        }
        if (found != std::string::npos) return from + static_cast<int64_t>(found);
    }
    return -1;
}

bool RawLogReader::read_chunk() {
    for (int64_t at = end_; at >= 0; at = find_kind(at + 1)) {
        if (read_chunk_at(at)) return true;
    }
    ended_ = true;
    note_tail(size_ - end_);
    note_unfinished_chunk();
    return false;
}

void RawLogReader::note_tail(int64_t bytes) {
    health_.tail_bytes = bytes;
    health_.tail_ticks = ticks_in(bytes);
}

int64_t RawLogReader::ticks_in(int64_t bytes) const {
    return health_.frames == 0 ? 0 : bytes * health_.frames / frame_bytes_;
}

void RawLogReader::note_unfinished_chunk() {
    ChunkHeader header{};
    in_.clear();
    in_.seekg(end_);
    in_.read(reinterpret_cast<char*>(&header), sizeof(header));
    const int64_t there = size_ - end_ - static_cast<int64_t>(sizeof(header));
    const bool known = header.kind == kData || header.kind == kDone;
    if (there < 0) {
        health_.unfinished = size_ > end_;
    } else if (known && header.size <= kMostPayload && header.size > there) {
        health_.unfinished = true;
        health_.tail_ticks = ticks_in(header.size);  // as many as it was to have
    }
}

void RawLogReader::note_frame() {
    const Time period = from_seconds(head_.tick);
    const Time last = health_.frames > 0 ? health_.last_time : -period;
    const int64_t missing = frame_.sequence - health_.last_tick - 1;
    health_.left_out += (frame_.time - last) / period - missing - 1;
    if (missing > 0) {
        health_.gaps.push_back(
            {health_.last_tick + 1, missing, health_.last_time, frame_.time, skipped_});
        // bodies that are not in this frame may have moved in those that are missing
        for (size_t i = 0; i < frame_.bodies.size(); ++i) {
            if (std::find(frame_.changed.begin(), frame_.changed.end(), i) != frame_.changed.end())
                continue;
            servo::BodyFrame& body = frame_.bodies[i];
            const Vec3 unknown = Vec3::Constant(servo::kUnmeasured);
            body = {
                {Quat(Eigen::Vector4d::Constant(servo::kUnmeasured)), unknown}, unknown, unknown};
        }
    }
    skipped_ = 0;
    ++health_.frames;
    health_.last_tick = frame_.sequence;
    health_.last_time = frame_.time;
}

const servo::Frame* RawLogReader::next() {
    while (at_ >= chunk_.size()) {
        if (ended_ || !read_chunk()) return nullptr;
        if (kind_ == kData) continue;
        chunk_.clear();
        if (kind_ != kDone) continue;
        health_.complete = ended_ = true;
        note_tail(skipped_);
    }
    uint32_t length = 0;
    const std::span<const std::byte> rest = std::span(chunk_).subspan(at_);
    if (rest.size() >= sizeof(length)) std::memcpy(&length, rest.data(), sizeof(length));
    const bool fits = rest.size() >= sizeof(length) + length;
    if (!fits || !decode(rest.subspan(sizeof(length), length), head_.layout(), frame_)) {
        throw Error({file_, 0}, "",
                    "holds a record that is no frame, in a chunk whose checksum is right",
                    "It was written by a faulty program: report it.");
    }
    at_ += sizeof(length) + length;
    frame_bytes_ += static_cast<int64_t>(sizeof(length) + length);
    note_frame();
    return &frame_;
}

}  // namespace dihaptic::recording
