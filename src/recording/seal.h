// Detects whether a session's tables, its session.nwb or its description in session.yaml were
// changed after the session ended. Each chunk of raw.log has a checksum, but a rehearsal keeps no
// log, and people who analyse a session often do not have the log either. The files are therefore
// sealed in session.yaml:
//
//   tables:                        for each table, its rows and a checksum of its bytes
//     - { file: trials.csv, rows: 24, checksum: 0a1b2c3d }
//     - { file: session.nwb, rows: 9000, checksum: 5c6d7e8f }     its rows are the ticks
//   seal: 4e5f6a7b                 a checksum of session.yaml's own data (identity, participant,
//                                  seed, program, state, ticks, inputs) and of the list above
//
// The checksums reveal damage, tables that a spreadsheet program saved again, and files of another
// session. They do not prevent forgery: whoever forges a table can also compute its seal.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "recording/session.h"

namespace dihaptic::recording {

/// The sealed tables that can be rebuilt from raw.log.
std::vector<std::string> tables_from_log();
/// The sealed tables that were written before the first tick or while the session ran.
std::vector<std::string> other_tables();

/// Seals the current state of a session's tables and of its session.nwb. The seal of session.nwb is
/// meant for people who read that file; the program itself reads raw.log instead. Tables that were
/// written before the first tick or while the session ran, and that are already in `info.tables`,
/// keep their seal, because they cannot be rebuilt.
void seal(const SessionFolder& folder, SessionInfo& info);

/// Removes the seal of a table that was rebuilt although raw.log does not contain its data; seal()
/// then computes a new seal.
void unseal(SessionInfo& info, std::string_view name);

/// Whether the session has seals. Sessions that are still running have none, and neither do
/// sessions recorded by an older version.
bool is_sealed(const SessionInfo& info);

/// Returns a problem if session.yaml has a seal that does not match its contents.
std::vector<Problem> broken_own_seal(const SessionFolder& folder, const SessionInfo& info,
                                     Severity severity);

/// Returns a problem for each mismatch: session.yaml's own seal, and each table that was truncated,
/// changed, removed or added since the session ended. Returns none if the session has no seals.
/// `only` lists the tables to check; if it is empty, all tables are checked.
std::vector<Problem> broken_seals(const SessionFolder& folder, const SessionInfo& info,
                                  Severity severity, std::span<const std::string_view> only = {});

/// Like broken_seals(), but only for tables that cannot be rebuilt from raw.log.
std::vector<Problem> broken_for_good(const SessionFolder& folder, const SessionInfo& info,
                                     Severity severity);

}  // namespace dihaptic::recording
