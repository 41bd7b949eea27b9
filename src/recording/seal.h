// Detects whether the tables of a session, its session.nwb, or its description in session.yaml
// changed after it ended. Each chunk of raw.log has a checksum, but a rehearsal keeps no log, and
// those who analyse a session often have no log either. The files are therefore sealed in
// session.yaml:
//
//   tables:                        for each table, its rows and a checksum of its bytes
//     - { file: trials.csv, rows: 24, checksum: 0a1b2c3d }
//     - { file: session.nwb, rows: 9000, checksum: 5c6d7e8f }     its rows are the ticks
//   seal: 4e5f6a7b                 a checksum of session.yaml's own data (identity, participant,
//                                  seed, program, state, ticks, inputs) and of the list above
//
// Checksums reveal damage, a spreadsheet that saved a table instead of only displaying it, and
// files of another session. They do not prevent forgery: whoever forges a table can seal it too.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "recording/session.h"

namespace dihaptic::recording {

/// The sealed tables that can be made again from raw.log.
std::vector<std::string> tables_from_log();
/// The sealed tables that were made before the first tick, or while the session ran.
std::vector<std::string> other_tables();

/// Seals the current state of a session's tables and of its session.nwb. The latter's seal is for
/// those who read that file: the program itself reads raw.log instead. Tables that were made before
/// the session's first tick or while it ran, and that are already in `info.tables`, keep their
/// seal, because they cannot be made again.
void seal(const SessionFolder& folder, SessionInfo& info);

/// Forgets the seal of a table that was rebuilt although raw.log does not contain it; seal() then
/// makes a new one.
void unseal(SessionInfo& info, std::string_view name);

/// Whether the session has seals. A running session has none, nor has one recorded by an older
/// version.
bool is_sealed(const SessionInfo& info);

/// A problem if session.yaml has a seal that does not match.
std::vector<Problem> broken_own_seal(const SessionFolder& folder, const SessionInfo& info,
                                     Severity severity);

/// A problem for each mismatch: session.yaml's own seal, and each table that was cut, changed,
/// removed or added since. None if there are no seals. `only`: the tables that matter; empty: all.
std::vector<Problem> broken_seals(const SessionFolder& folder, const SessionInfo& info,
                                  Severity severity, std::span<const std::string_view> only = {});

/// Like broken_seals(), for the tables that cannot be made again from raw.log.
std::vector<Problem> broken_for_good(const SessionFolder& folder, const SessionInfo& info,
                                     Severity severity);

}  // namespace dihaptic::recording
