// The JSON Schemas of the files that people write, for editors (base/json_schema.h).
#pragma once

#include <span>
#include <string>

namespace dihaptic::session {

struct FileSchema {
    const char* name;       ///< name of the kind of file, and of its schema's file
    std::string (*json)();  ///< the schema's text
};

/// All schemas.
std::span<const FileSchema> file_schemas();
/// The schema with this name. Throws Error when there is none.
const FileSchema& file_schema(const std::string& name);

/// A first line, with its line end, from which an editor finds a file's schema; "" if the schemas
/// are missing.
std::string schema_line(const std::string& name);

}  // namespace dihaptic::session
