// Finds the program's own files, either in its build folder and the checkout around it, or in an
// installation (PREFIX/bin, PREFIX/libexec/dihaptic and PREFIX/share/dihaptic). PREFIX is not
// compiled in, so an installation can be moved.
#pragma once

#include <initializer_list>
#include <string>

namespace dihaptic {

/// Searches the folder of this code, then the folders above it, nearest first, and finally
/// /usr/local and /usr for files with these names. Returns the first that exists, or "" if there is
/// none. "This code" is the running program, or a shared library such as a Python module.
std::string in_or_above_program(std::initializer_list<std::string> names);

/// The folder of the files that come with the program: experiments, scenes, rigs and the files that
/// these need. "" if the folder is missing.
std::string shipped_folder();

/// Finds the file with this name, e.g. scenes/block-on-table.yaml: first in the folder where a user
/// keeps files for all studies ($XDG_DATA_HOME/dihaptic or ~/.local/share/dihaptic), then among the
/// files that come with the program. "" if there is no such file, or if the path is absolute.
std::string kept(const std::string& name);

/// Returns `name` if there is a file or folder with that name, and otherwise kept(name) or, if that
/// is empty, `name`.
std::string given_or_kept(const std::string& name);

/// Finds the file to which a name written in a file of `folder` refers. The name is relative to the
/// folder; if nothing is found there, kept() looks it up, without any leading ../. A copy of a
/// shipped file can therefore be put anywhere and still finds its files. If the file is found in
/// neither way, the (missing) path within the folder is returned.
std::string named_in(const std::string& folder, const std::string& name);

}  // namespace dihaptic
