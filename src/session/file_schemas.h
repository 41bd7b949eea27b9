// JSON Schemas for the files that people write, for use by editors (base/json_schema.h).
#pragma once

#include <span>
#include <string>

namespace dihaptic::session {

struct FileSchema {
    const char* name;       ///< name of the kind of file; also the name of its schema file
    std::string (*json)();  ///< the schema's text
};

/// All schemas.
std::span<const FileSchema> file_schemas();
/// Returns the schema with this name. Throws Error if there is none.
const FileSchema& file_schema(const std::string& name);

/// Returns the first line for a file (including the line break), which tells editors where to find
/// the file's schema; "" if the schemas are not installed.
std::string schema_line(const std::string& name);

}  // namespace dihaptic::session
