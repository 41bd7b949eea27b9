// Where the program's own files are: in the folder that it was built in and the checkout around
// that, or where an installation has put them: PREFIX/bin, PREFIX/libexec/dihaptic and
// PREFIX/share/dihaptic. An installation may be moved: PREFIX is not compiled in.
#pragma once

#include <initializer_list>
#include <string>

namespace dihaptic {

/// The first of the files `names` that there is in the folder of this code or in one above it, the
/// nearest folder first, then in /usr/local and /usr; "" if there is none. This code is in the
/// running program, or in a shared library such as a module of Python's.
std::string in_or_above_program(std::initializer_list<std::string> names);

/// The folder of what comes with the program: experiments, scenes, rigs and the files that these
/// need. "" if it is missing.
std::string shipped_folder();

/// What has this name, e.g. scenes/block-on-table.yaml, in the folder where a user keeps files of
/// all studies, $XDG_DATA_HOME/dihaptic or ~/.local/share/dihaptic, or else in what comes with the
/// program; "" if neither has it, and of a path that is absolute.
std::string kept(const std::string& name);

/// `name` if there is such a file or folder, or else kept(name); `name`, which is missing, if
/// neither is there.
std::string given_or_kept(const std::string& name);

/// The file that a file in `folder` names: relative to the folder or, where that is missing, kept;
/// a leading ../ counts for nothing then. So a copy of a shipped file finds what it names wherever
/// it is put. If neither is there, the one in the folder, which is missing.
std::string named_in(const std::string& folder, const std::string& name);

}  // namespace dihaptic
