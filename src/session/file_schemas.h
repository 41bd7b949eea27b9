// The JSON Schemas of the files that people write, for editors (base/json_schema.h).
#pragma once

#include <span>
#include <string>

namespace dihaptic::session {

struct FileSchema {
    const char* name;       ///< of the kind of file, and of its schema's file
    std::string (*json)();  ///< the schema's text
};

/// All of them.
std::span<const FileSchema> file_schemas();
/// The schema of that name. Throws Error when there is none.
const FileSchema& file_schema(const std::string& name);

/// A comment by which an editor finds the schema of a file that begins with it, with the end of its
/// line; "" if the schemas are not there.
std::string schema_line(const std::string& name);

}  // namespace dihaptic::session
