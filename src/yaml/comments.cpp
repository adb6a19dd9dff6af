#include "yaml/comments.hpp"

#include <cstddef>

namespace bbsim::yaml {
namespace {

// Letters and digits, of other alphabets too (UTF-8): no quoted scalar begins behind one.
bool is_of_word(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte >= '0' && byte <= '9') || (byte >= 'a' && byte <= 'z') ||
         (byte >= 'A' && byte <= 'Z') || byte >= 0x80;
}

bool may_open_a_scalar(std::string_view line, std::size_t quote) {
  return quote == 0 || !is_of_word(line[quote - 1]);
}

// Whether the quote closes a scalar, if it is within one: it is neither escaped nor doubled.
bool surely_closes(std::string_view line, std::size_t quote) {
  const char before = line[quote - 1];
  const bool doubled = quote + 1 < line.size() && line[quote + 1] == line[quote];
  return before != '\\' && before != line[quote] && !doubled;
}

// Whether every quote of the line that could begin a scalar has one behind it that ends it.
bool surely_ends_closed(std::string_view line) {
  for (const char kind : {'"', '\''}) {
    bool closes = false;  // a quote further on
    for (std::size_t i = line.rfind(kind); i != std::string_view::npos;
         i = i == 0 ? std::string_view::npos : line.rfind(kind, i - 1)) {
      if (may_open_a_scalar(line, i) && !closes) return false;
      closes = closes || (i > 0 && surely_closes(line, i));
    }
  }
  return true;
}

// Whether a line might end where we see no end.
bool has_other_line_ends(std::string_view text) {
  for (std::size_t i = text.find('\r'); i != std::string_view::npos; i = text.find('\r', i + 1)) {
    if (i + 1 == text.size() || text[i + 1] != '\n') return true;
  }
  return false;
}

}  // namespace

std::string with_short_comments(std::string_view text) {
  if (has_other_line_ends(text)) return std::string(text);
  std::string result;
  result.reserve(text.size());
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t newline = rest.find('\n');
    const std::string_view line = rest.substr(0, newline);
    if (line.starts_with('#')) {
      result += '#';
    } else {
      if (!surely_ends_closed(line)) return std::string(text);
      result += line;
    }
    if (newline == std::string_view::npos) break;
    result += '\n';
    rest.remove_prefix(newline + 1);
  }
  return result;
}

}  // namespace bbsim::yaml
