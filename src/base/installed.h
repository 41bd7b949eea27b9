// Finds the program's own files: in the folder in which it was built and the checkout around it, or
// in an installation (PREFIX/bin, PREFIX/libexec/dihaptic and PREFIX/share/dihaptic). PREFIX is not
// compiled in, so an installation may be moved.
#pragma once

#include <initializer_list>
#include <string>

namespace dihaptic {

/// The first of the files `names` that exists in the folder of this code or in a folder above it,
/// the nearest folder first, then in /usr/local and /usr; "" if none exists. "This code" is the
/// running program, or a shared library such as a Python module.
std::string in_or_above_program(std::initializer_list<std::string> names);

/// The folder of the files that come with the program: experiments, scenes, rigs and the files that
/// they need. "" if the folder is missing.
std::string shipped_folder();

/// The file with this name, e.g. scenes/block-on-table.yaml, in the folder where a user keeps files
/// for all studies ($XDG_DATA_HOME/dihaptic or ~/.local/share/dihaptic) or, failing that, among the
/// files that come with the program. "" if neither has it, or if the path is absolute.
std::string kept(const std::string& name);

/// `name` if such a file or folder exists, otherwise kept(name); `name` again if neither exists.
std::string given_or_kept(const std::string& name);

/// The file with a name that a file in `folder` contains: relative to the folder or, if it is
/// missing there, kept() without a leading ../. A copy of a shipped file can therefore be put
/// anywhere and still finds its files. If neither exists, the (missing) file in the folder.
std::string named_in(const std::string& folder, const std::string& name);

}  // namespace dihaptic
