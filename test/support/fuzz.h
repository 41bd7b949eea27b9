// What a fuzzer's target needs to hand bytes to a reader of files. A target is a
// FOLDER/fuzz/NAME_fuzz.cpp with one function, LLVMFuzzerTestOneInput(), and initial files in
// NAME_corpus beside it.
// `./dev fuzz` feeds it nonsense; the tests feed it the corpus, so that what was found once stays
// found: add the file that made it fail.
#pragma once

#include <cstdint>
#include <fstream>
#include <span>
#include <string>

#include "base/temporary_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace dihaptic::testing {

/// Path of a file with these bytes and that name, alone in its folder until the next call.
inline std::string as_file(std::span<const uint8_t> bytes, const std::string& name) {
    static const TemporaryFolder folder;
    std::string file = folder.file(name);
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    return file;
}

}  // namespace dihaptic::testing
