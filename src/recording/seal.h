// Tells whether the tables of a session, and what session.yaml says of who did it, are what they
// were when it ended. raw.log has a checksum in each of its chunks; of a rehearsal, which keeps no
// log, there is nothing but tables. They are sealed in session.yaml:
//
//   tables:                        of each table its rows, and a checksum of its bytes
//     - { file: trials.csv, rows: 24, checksum: 0a1b2c3d }
//   seal: 4e5f6a7b                 a checksum of session.yaml's own (identity, participant, seed,
//                                  program, state, ticks, inputs) and of the list above
//
// Checksums tell damage, a spreadsheet that saved what it was to show, and files of another
// session; whoever means to forge a table can seal it too.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "recording/session.h"

namespace dihaptic::recording {

/// The tables that are sealed and can be made anew from raw.log.
std::vector<std::string> tables_from_log();
/// Those that are sealed and were made before the first tick, or while the session ran.
std::vector<std::string> other_tables();

/// Seals a session's tables as they are now. Those that were made before its first tick, or while
/// it ran, and are in `info.tables` already, keep their seal: nothing can make them anew.
void seal(const SessionFolder& folder, SessionInfo& info);

/// Whether the session has seals. It has none while it runs, and if an older version recorded it.
bool is_sealed(const SessionInfo& info);

/// The problem that session.yaml's own seal does not fit, if it has one and does not.
std::vector<Problem> broken_own_seal(const SessionFolder& folder, const SessionInfo& info,
                                     Severity severity);

/// A problem for each thing that is not as the seals say: session.yaml's own, and each table that
/// was cut, changed, removed or added since. None if there are no seals. `only`: the tables that
/// matter; empty: all.
std::vector<Problem> broken_seals(const SessionFolder& folder, const SessionInfo& info,
                                  Severity severity, std::span<const std::string_view> only = {});

/// As broken_seals(), for the tables that cannot be made anew from raw.log.
std::vector<Problem> broken_for_good(const SessionFolder& folder, const SessionInfo& info,
                                     Severity severity);

}  // namespace dihaptic::recording
