#include "base/unsaved.h"

#include <utility>

namespace dihaptic {
namespace {

thread_local const Unsaved* now = nullptr;

}  // namespace

Unsaved::Unsaved(std::string file, std::string text)
    : file_(std::move(file)), text_(std::move(text)) {
    now = this;
}

Unsaved::~Unsaved() {
    now = nullptr;
}

const std::string* Unsaved::text_of(const std::string& file) {
    return now != nullptr && now->file_ == file ? &now->text_ : nullptr;
}

}  // namespace dihaptic
