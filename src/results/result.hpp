// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A result, or the log of a real rig, read from files: its columns, and the known facts of its
// scene. Logs are CSV with any names, units and clocks. Of a sweep: the keys that vary in it.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "file/table.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::results {

using file::Column;

struct Event {
  std::string name;
  bool stopped = false;
  double t = 0, x = 0, y = 0;             // s, m
  std::map<std::string, double> state{};  // columns of `bbsim columns` at that time, if known
};

// Its numbers are in SI units.
struct Result : file::Table {
  // Facts that a CSV cannot hold; empty if unknown.
  std::string title, status;
  std::string reason, version;       // why a run ended early; bbsim that ran it
  std::string summary;               // JSON, as `run --summary` writes it, without scenario_text
  std::string beside;                // the file beside it that was tried as its summary
  std::string left_out;              // message about a summary beside it of another run
  std::optional<double> end_time{};  // time that the run reached, s
  std::vector<Event> events{};
  std::optional<Scenario> scenario{};
  std::vector<std::string> drawn_keys{};  // keys of a sweep with random values
  bool drawn_keys_known = false;          // whether drawn_keys is known
  // Whether columns of `bbsim columns` have its units if the file gives none. False for tables that
  // nothing identifies as results of bbsim.
  bool units_known = true;
  bool has_end_row = false;        // added by add_end_row()
  std::vector<std::string> raw{};  // columns of a log from which others were made

  // The name of its file in a picture.
  [[nodiscard]] std::string shown_file() const;
  // Whether each row is a case, as `bbsim sweep` writes them.
  [[nodiscard]] bool is_sweep() const;
};

// Adds the instant at which an event stopped a run as the last row, if it lies after the last one.
// The row has the event's values, and NaN or an empty text in all other columns.
void add_end_row(Result& result);

// The user's options for a log.
struct LogChoice {
  // "NAME=[FACTOR*]COLUMN[+OFFSET|-OFFSET][:UNIT]", or a list of these with commas. Each makes a
  // column of `bbsim columns` from a column of the log.
  std::vector<std::string> maps{};
  std::vector<std::string> header{};  // the columns' names, if the file has none
  std::string period{};               // time between rows, if they have no clock
  std::string time_offset{};          // a time, "start", or "auto"
  std::string missing{};              // the number in place of a position that was not seen

  [[nodiscard]] bool given() const {
    return !maps.empty() || !header.empty() || !period.empty() || !time_offset.empty() ||
           !missing.empty();
  }
  [[nodiscard]] bool aligns() const { return time_offset == "auto"; }
};

// Reads a log. Its columns get names of bbsim and SI units, as far as `choice` or their own names
// define them; times are made to increase. Its notes tell the changes. Keeps unmapped columns,
// unless `only_mapped`. "auto" leaves the times unchanged, for time_offset() in
// record/log_distance.hpp. Throws InputError with the place in the log or in the map, the text
// found and the texts allowed.
[[nodiscard]] Result read_log(const std::string& file, const LogChoice& choice,
                              bool only_mapped = false);

// Does the same to a log already read.
void make_log(Result& log, const LogChoice& choice, bool only_mapped);

// What is wrong with a log that lacks times: its columns, also those of text, and the remedy.
[[nodiscard]] std::string without_clock(const Result& log);

// Throws InputError if "auto" is requested without a run to align with.
void refuse_auto(const LogChoice& choice);

// Sources for facts that a CSV file cannot hold. Each may be empty.
struct Beside {
  std::string summary;                 // written by `bbsim run --summary`
  std::string scenario;                // the scenario of the run
  std::vector<std::string> overrides;  // each "key.path=value"
};

// Reads a CSV or HDF5 file of a run or a sweep, or any other CSV file with a header; "-" is CSV on
// standard input. HDF5 files describe their scene. For a CSV without a named summary, reads
// NAME.json beside NAME.csv if it is a summary of that file, with as many rows and no older. A
// named scenario overrides both. Throws InputError. Reads a CSV as a log if nothing identifies it
// as a result of bbsim or if `log` has options.
[[nodiscard]] Result read_result(const std::string& file, const Beside& beside,
                                 const LogChoice& log = {});

// A result in memory: its columns, of one length, and its summary as `run --summary` writes it,
// which may be empty.
[[nodiscard]] Result result_of(std::vector<Column> columns, const std::string& summary);

// NAME.json beside NAME.csv, which read_result() may use; empty if there is none.
[[nodiscard]] std::string summary_beside(const std::string& file);

// Reads only the columns; `header` names those of a CSV if the file does not. Throws InputError.
[[nodiscard]] Result read_columns(const std::string& file, const std::vector<std::string>& header);

// A key that has more than one value.
struct Key {
  std::string name;
  std::vector<double> values;         // one for each case; index into `labels` for a text
  std::vector<double> distinct;       // in increasing order
  std::vector<std::string> labels{};  // of a text, in order of appearance
  std::string unit{};                 // from the file; empty if unknown
  bool drawn = false;                 // at random
  std::size_t leader = 0;             // the first key that varies together with it

  [[nodiscard]] bool is_text() const { return !labels.empty(); }
};

struct SweepTable {
  std::vector<Key> keys;
  std::vector<std::string> status;  // one word for each case
  std::vector<const Column*> measures;
  // Each status except `done`, in order of appearance, and its number of cases.
  std::vector<std::pair<std::string, std::size_t>> others{};

  [[nodiscard]] bool done(std::size_t a_case) const { return status[a_case] == "done"; }
  // Names of the keys that vary together with this one.
  [[nodiscard]] std::vector<std::string> followers(const Key& key) const;
};

// Columns before `status` are keys, numbers after it measures. `end_time` is a measure if the cases
// end at different times. If the file does not tell, a key counts as drawn if more than half of
// many cases have distinct values in no order.
[[nodiscard]] SweepTable sweep_table(const Result& sweep);

}  // namespace bbsim::results
