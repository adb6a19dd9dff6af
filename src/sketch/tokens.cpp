// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sketch/tokens.hpp"

#include <algorithm>
#include <string>

namespace bbsim::sketch {
namespace {

bool begins_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         (static_cast<unsigned char>(c) & 0x80U) != 0;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

class Scanner {
 public:
  explicit Scanner(std::string_view source) : source_(source) {}

  std::vector<Token> tokens() {
    bool line_starts = true;
    while (at_ < source_.size()) {
      const char c = source_[at_];
      if (c == '\n') {
        line_starts = true;
        ++at_;
      } else if (c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v') {
        ++at_;
      } else if (next_is("//")) {
        at_ = end_of_line(at_);
      } else if (next_is("/*")) {
        at_ = after("*/", at_ + 2);
      } else if (c == '#' && line_starts) {
        add(Token::Kind::directive, end_of_directive());
      } else {
        line_starts = false;
        add_word(c);
      }
    }
    return std::move(tokens_);
  }

 private:
  void add(Token::Kind kind, std::size_t end) {
    tokens_.push_back({kind, source_.substr(at_, end - at_), at_});
    at_ = end;
  }

  void add_word(char c) {
    if (begins_name(c)) {
      const std::size_t end = end_of_word(at_, false);
      const std::string_view name = source_.substr(at_, end - at_);
      if (end < source_.size() && source_[end] == '"' && name.ends_with('R') && name.size() <= 3) {
        return add(Token::Kind::other, end_of_raw_string(end));
      }
      return add(Token::Kind::name, end);
    }
    if (is_digit(c)) return add(Token::Kind::other, end_of_word(at_, true));
    if (c == '"' || c == '\'') return add(Token::Kind::other, end_of_string(c));
    add(Token::Kind::other, at_ + (next_is("::") || next_is("->") ? 2 : 1));
  }

  [[nodiscard]] bool next_is(std::string_view what) const {
    return source_.substr(at_).starts_with(what);
  }
  // The offset after the next `what`, or the end of the text.
  [[nodiscard]] std::size_t after(std::string_view what, std::size_t from) const {
    const std::size_t found = source_.find(what, from);
    return found == std::string_view::npos ? source_.size() : found + what.size();
  }
  // The end of the line, including the lines that a backslash joins to it.
  [[nodiscard]] std::size_t end_of_line(std::size_t from) const {
    while (true) {
      const std::size_t end = std::min(source_.find('\n', from), source_.size());
      const std::size_t last = end > 0 && source_[end - 1] == '\r' ? end - 1 : end;
      if (end == source_.size() || last == 0 || source_[last - 1] != '\\') return end;
      from = end + 1;
    }
  }
  // A comment that begins in a directive may span several lines.
  [[nodiscard]] std::size_t end_of_directive() const {
    std::size_t end = end_of_line(at_);
    for (std::size_t from = at_; (from = source_.substr(0, end).find("/*", from)) < end;) {
      from = after("*/", from + 2);
      if (from > end) end = end_of_line(from);
    }
    return end;
  }
  // Numbers may contain points and, between digits, apostrophes.
  [[nodiscard]] std::size_t end_of_word(std::size_t from, bool number) const {
    while (from < source_.size() && (begins_name(source_[from]) || is_digit(source_[from]) ||
                                     (number && (source_[from] == '.' || source_[from] == '\'')))) {
      ++from;
    }
    return from;
  }
  [[nodiscard]] std::size_t end_of_string(char quote) const {
    std::size_t end = at_ + 1;
    while (end < source_.size() && source_[end] != quote && source_[end] != '\n') {
      end += source_[end] == '\\' ? 2 : 1;
    }
    return std::min(end + 1, source_.size());
  }
  [[nodiscard]] std::size_t end_of_raw_string(std::size_t quote) const {
    const std::size_t open = source_.find('(', quote);
    if (open == std::string_view::npos) return source_.size();
    std::string close = ")";
    close.append(source_.substr(quote + 1, open - quote - 1)).push_back('"');
    return after(close, open);
  }

  std::string_view source_;
  std::size_t at_ = 0;
  std::vector<Token> tokens_;
};

}  // namespace

std::vector<Token> tokens_of(std::string_view source) {
  return Scanner(source).tokens();
}

}  // namespace bbsim::sketch
