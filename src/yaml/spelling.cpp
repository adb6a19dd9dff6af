// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/spelling.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "base/text.hpp"

namespace bbsim::yaml {
namespace {

struct Word {
  std::string_view american, british;
};
// All words with two spellings that occur in keys.
constexpr std::array words{Word{"center", "centre"}, Word{"linearization", "linearisation"}};

// Underscores and dots separate the words of a path.
bool parts(char c) {
  return c == '_' || c == '.';
}

bool is_word(std::string_view path, std::size_t begin, std::size_t size) {
  const std::size_t end = begin + size;
  return (begin == 0 || parts(path[begin - 1])) && (end == path.size() || parts(path[end]));
}

std::string spelled(std::string_view path, std::string_view Word::*from,
                    std::string_view Word::*to) {
  std::string text(path);
  for (const Word& word : words) {
    const std::string_view old = word.*from;
    for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, at + 1)) {
      if (is_word(text, at, old.size())) text.replace(at, old.size(), word.*to);
    }
  }
  return text;
}

// The Damerau-Levenshtein distance (optimal string alignment), row by row.
std::size_t typing_errors(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> above(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(above);
    above.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + changed});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

struct Synonym {
  std::string_view word, path;
};
constexpr std::array synonyms{
    Synonym{"servo", "gimbal.servo"},
    Synonym{"servos", "gimbal.servo"},
    Synonym{"motor", "gimbal.motor"},
    Synonym{"sensor", "controller.sensor"},
    Synonym{"camera", "controller.sensor"},
    Synonym{"sampling", "controller.sampling"},
    Synonym{"sample_time", "controller.sampling.period"},
    Synonym{"sampling_time", "controller.sampling.period"},
    Synonym{"delay", "controller.sampling.delay"},
    Synonym{"latency", "controller.sampling.delay"},
    Synonym{"noise", "controller.sensor.noise"},
    Synonym{"kd", "controller.pd.kv"},
    Synonym{"setpoint", "controller.reference"},
    Synonym{"set_point", "controller.reference"},
    Synonym{"target", "controller.reference"},
    Synonym{"max_rate", "gimbal.servo.rate_limit"},
    Synonym{"max_speed", "gimbal.servo.rate_limit"},
    Synonym{"speed", "gimbal.servo.rate_limit"},
    Synonym{"max_angle", "gimbal.servo.angle_limit"},
    Synonym{"dt", "time.step"},
    Synonym{"timestep", "time.step"},
    Synonym{"duration", "time.end"},
    Synonym{"disturbance", "ball.push"},
    Synonym{"force", "ball.push"},
    Synonym{"initial_position", "ball.position"},
    Synonym{"diameter", "ball.radius"},
    Synonym{"width", "plate.size"},
};

}  // namespace

std::string american(std::string_view path) {
  return spelled(path, &Word::british, &Word::american);
}

std::string british(std::string_view path) {
  return spelled(path, &Word::american, &Word::british);
}

std::optional<std::string> other_spelling(std::string_view name) {
  // Most names have one spelling. They return without making a string, because a sweep looks up
  // many names.
  const auto holds = [&](std::string_view word) {
    return name.find(word) != std::string_view::npos;
  };
  for (const Word& word : words) {
    if (holds(word.british)) return american(name);
    if (holds(word.american)) return british(name);
  }
  return {};
}

std::string_view nearest_name(std::string_view word, std::span<const std::string_view> names) {
  std::string_view best;
  constexpr std::size_t longest = 64;  // no name is near a longer word
  if (word.empty() || word.size() > longest) return best;

  const std::string wanted = lower(word);
  std::size_t fewest = longest;
  for (const std::string_view name : names) {
    if (wanted.size() >= 3 && name.starts_with(wanted)) return name;
    const std::size_t errors = typing_errors(wanted, lower(name));
    const bool near = 3 * errors <= std::max(wanted.size(), name.size());
    if (near && errors < fewest) {
      fewest = errors;
      best = name;
    }
  }
  return best;
}

std::string hint(std::string_view word, std::span<const std::string_view> names) {
  const std::string_view nearest = nearest_name(word, names);
  return nearest.empty() || nearest == word ? "" : " (did you mean " + shown(nearest) + "?)";
}

std::string_view synonym(std::string_view word, std::span<const std::string_view> known) {
  const auto* const found = std::ranges::find(synonyms, word, &Synonym::word);
  if (found == synonyms.end()) return {};
  const std::string_view key = found->path.substr(found->path.rfind('.') + 1);
  const auto here = std::ranges::find(known, key);
  return here == known.end() ? found->path : *here;
}

}  // namespace bbsim::yaml
