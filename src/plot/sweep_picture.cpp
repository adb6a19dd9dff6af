// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/sweep_picture.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/text.hpp"
#include "plot/sweep_parts.hpp"
#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

// More values make a map instead of a line for each.
constexpr std::size_t most_groups = 5;

// The keys on the axes: two for a map, one for lines, none for histograms.
struct Form {
  const Key* over = nullptr;
  const Key* against = nullptr;
  const Key* group = nullptr;  // a line for each of its values
};

template <class Named>
std::string names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const auto& one : all) names.push_back(one.name);
  return joined(names);
}

const Key& find_key(const SweepTable& table, const std::string& name) {
  const auto found = std::ranges::find(table.keys, name, &Key::name);
  if (found != table.keys.end()) return *found;
  throw InputError("--over: found " + name + "; what varies: " + names_of(table.keys));
}

// Keys with listed values, except those that vary with another key.
std::vector<const Key*> listed_keys(const SweepTable& table) {
  std::vector<const Key*> keys;
  for (std::size_t k = 0; k < table.keys.size(); ++k) {
    if (!table.keys[k].drawn && table.keys[k].leader == k) keys.push_back(&table.keys[k]);
  }
  return keys;
}

// A line for each of its values is better than a map with so few rows.
bool makes_groups(const Key& key) {
  return key.distinct.size() <= most_groups || key.is_text();
}

Form form_over(const SweepTable& table, const std::vector<std::string>& names) {
  if (names.size() > 2) {
    throw InputError("--over: found " + joined(names) + "; allowed: one key, or two");
  }
  const Key& first = find_key(table, names[0]);
  if (names.size() == 2) {
    const Key& second = find_key(table, names[1]);
    if (&first == &second) throw InputError("--over: found " + names[0] + " twice");
    return {&first, &second};
  }
  if (first.drawn) return {&first};
  const Key* group = nullptr;
  for (const Key* key : listed_keys(table)) {
    if (key->leader != first.leader && makes_groups(*key) && group == nullptr) group = key;
  }
  return {&first, nullptr, group};
}

Form choose_form(const SweepTable& table, const std::vector<std::string>& over) {
  if (!over.empty()) return form_over(table, over);
  std::vector<const Key*> keys = listed_keys(table);
  if (keys.empty()) return {};
  // The two with the most values, in the file's order.
  const auto more = [](const Key* a, const Key* b) {
    return a->distinct.size() > b->distinct.size();
  };
  std::vector<const Key*> by_count = keys;
  std::ranges::stable_sort(by_count, more);
  if (by_count.size() == 1) return {by_count[0]};
  const Key *first = by_count[0], *second = by_count[1];
  if (makes_groups(*second) && !first->is_text()) return {first, nullptr, second};
  if (std::ranges::find(keys, first) > std::ranges::find(keys, second)) std::swap(first, second);
  return {first, second};
}

// The requested measures; by default those that vary, or all if none does.
std::vector<const Column*> choose_measures(const SweepTable& table, const Result& sweep,
                                           const std::vector<std::string>& asked) {
  std::vector<const Column*> measures;
  for (const std::string& name : asked) {
    const Column* const found = sweep.find(name);
    if (std::ranges::find(table.measures, found) == table.measures.end() && name != "end_time") {
      std::vector<std::string> names;
      for (const Column* measure : table.measures) names.push_back(measure->name);
      throw InputError("--columns: found " + (name.empty() ? "nothing" : name) + "; measures of " +
                       sweep.file + ": " + joined(names));
    }
    measures.push_back(found);
  }
  if (!measures.empty()) return measures;
  for (const Column* measure : table.measures) {
    if (MeasureAxis(table, *measure).range.wide()) measures.push_back(measure);
  }
  return measures.empty() ? table.measures : measures;
}

// Describes medians over the keys that are not on an axis; empty if there are none.
std::string taken_over(const SweepTable& table, const Form& form) {
  if (form.over == nullptr || form.over->drawn) return "";
  std::vector<std::string> listed, drawn;
  for (const Key& key : table.keys) {
    const auto leads = [&](const Key* axis) {
      return axis != nullptr && axis->leader == key.leader;
    };
    if (leads(form.over) || leads(form.against) || leads(form.group)) continue;
    (key.drawn ? drawn : listed).push_back(key.name);
  }
  if (listed.empty() && drawn.empty()) return "";
  const bool bands = form.against == nullptr &&
                     (form.group == nullptr || form.group->distinct.size() <= most_bands);
  return (bands ? "; median, and 5 to 95 % as a band, over " : "; median over ") + joined(listed) +
         (listed.empty() || drawn.empty() ? "" : " and ") +
         (drawn.empty() ? "" : "draws of " + joined(drawn));
}

}  // namespace

Picture sweep_picture(const Result& sweep, const SweepChoice& choice) {
  const SweepTable table = sweep_table(sweep);
  if (table.keys.empty()) throw InputError(sweep.file + ": nothing to draw: no key varies");
  const std::vector<const Column*> measures = choose_measures(table, sweep, choice.measures);
  if (measures.empty()) throw InputError(sweep.file + ": nothing to draw: it has no measures");
  const Form form = choose_form(table, choice.over);
  const bool map = form.against != nullptr, histogram = form.over == nullptr;
  const bool one = measures.size() == 1;

  Picture picture;
  picture.title = sweep.title.empty() ? sweep.shown_file() : sweep.title;
  picture.subtitle = (sweep.title.empty() ? "" : sweep.shown_file() + ", ") +
                     std::to_string(sweep.rows) + " cases" + taken_over(table, form);
  picture.legend = group_legend(form.group);
  for (const auto& [status, cases] : table.others) {
    picture.legend.push_back(
        {status + ": " + std::to_string(cases) + (cases == 1 ? " case" : " cases"),
         stroke_of_status(table, status)});
  }
  picture.width = one ? 900 : 1200;
  const double pitch = one ? 440 : map ? 320 : histogram ? 230 : 185;
  const double below = histogram ? 52 : 12;  // histograms have their own tics and label
  const std::size_t columns = one ? 1 : 2, rows = (measures.size() + columns - 1) / columns;
  picture.height = pitch * static_cast<double>(rows) + (histogram ? 10 : 50);
  for (std::size_t m = 0; m < measures.size(); ++m) {
    const double left = m % columns == 0 ? 88 : 688;
    const double y = pitch * static_cast<double>(m / columns);
    const Box box{left, y + 28, one ? picture.width - 30 : left + 482, y + pitch - below};
    const SweepPanel of{table, *measures[m], box, m + columns >= measures.size()};
    picture.panels.push_back(map         ? map_panel(of, *form.over, *form.against)
                             : histogram ? histogram_panel(of)
                                         : line_panel(of, *form.over, form.group));
  }
  return picture;
}

}  // namespace bbsim::plot
