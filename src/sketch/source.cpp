// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sketch/source.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace bbsim::sketch {
namespace {

// A token of a C++ source, without comments and blanks. Tokens suffice to find its functions.
struct Token {
  enum class Kind { name, other, directive } kind;
  std::string_view text;  // part of the source; for a directive, its lines from # on
  std::size_t offset;     // in the source

  [[nodiscard]] bool is(std::string_view what) const { return text == what; }
};
using Tokens = std::vector<Token>;

bool begins_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         (static_cast<unsigned char>(c) & 0x80U) != 0;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Makes the tokens of a source, which must outlive them. A name, number, string, directive, "::" or
// "->" is one token, and so is every other character.
class Scanner {
 public:
  explicit Scanner(std::string_view source) : source_(source) {}

  Tokens tokens() {
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
  Tokens tokens_;
};

// Tokens [begin, end): through its semicolon, or through the closing brace of its body.
struct Declaration {
  std::size_t begin, end;
  std::size_t head;  // its first brace, or else what ends it
  int conditions;    // number of #if around it
};

std::size_t after_brace(const Tokens& tokens, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < tokens.size(); ++i) {
    if (tokens[i].is("{")) ++depth;
    if (tokens[i].is("}") && --depth == 0) return i + 1;
  }
  return tokens.size();
}

std::vector<Declaration> declarations_of(const Tokens& tokens) {
  std::vector<Declaration> found;
  int conditions = 0;
  for (std::size_t i = 0; i < tokens.size();) {
    if (tokens[i].kind == Token::Kind::directive) {
      const std::string_view text = tokens[i].text;
      const std::size_t word = std::min(text.find_first_not_of(" \t", 1), text.size());
      if (text.substr(word).starts_with("if")) ++conditions;
      if (text.substr(word).starts_with("endif")) --conditions;
      ++i;
      continue;
    }
    Declaration declaration{i, i, 0, conditions};
    while (i < tokens.size() && !tokens[i].is(";") && !tokens[i].is("{") &&
           tokens[i].kind != Token::Kind::directive) {
      ++i;
    }
    declaration.head = i;
    if (i < tokens.size() && tokens[i].is("{")) i = after_brace(tokens, i);
    if (i < tokens.size() && tokens[i].is(";")) ++i;
    declaration.end = std::max(i, declaration.begin + 1);
    i = declaration.end;
    found.push_back(declaration);
  }
  return found;
}

// The function that a declaration names.
struct Function {
  std::string_view name;
  std::size_t open;   // the "(" of its parameters
  std::size_t close;  // and the ")"
};

std::optional<Function> function_of(const Tokens& tokens, const Declaration& declaration) {
  static constexpr std::string_view others[] = {"template", "typedef", "using",     "namespace",
                                                "operator", "auto",    "constexpr", "="};
  std::size_t close = declaration.head;
  while (close > declaration.begin && tokens[close - 1].is("noexcept")) --close;
  if (close == declaration.begin || !tokens[close - 1].is(")")) return {};
  --close;
  std::size_t open = close;
  for (int depth = 0; open > declaration.begin; --open) {
    if (tokens[open].is(")")) ++depth;
    if (tokens[open].is("(") && --depth == 0) break;
  }
  if (open < declaration.begin + 2) return {};  // has no return type
  for (std::size_t i = declaration.begin; i < open; ++i) {
    if (std::ranges::find(others, tokens[i].text) != std::end(others)) return {};
  }
  const Token& name = tokens[open - 1];
  const Token& before = tokens[open - 2];
  if (name.kind != Token::Kind::name || before.is("::") || before.is(".")) return {};
  return Function{name.text, open, close};
}

// Leaves out default arguments, because the definition repeats them.
std::string prototype_of(const Tokens& tokens, const Declaration& declaration,
                         const Function& function) {
  std::string text;
  int depth = 0;
  bool by_default = false;
  for (std::size_t i = declaration.begin; i <= function.close; ++i) {
    const Token& token = tokens[i];
    if (i > function.open && i < function.close) {
      if (token.is("(") || token.is("{") || token.is("[")) ++depth;
      if (token.is(")") || token.is("}") || token.is("]")) --depth;
      if (token.is("=") && depth == 0) by_default = true;
      if (token.is(",") && depth == 0) by_default = false;
      if (by_default) continue;
    }
    text.append(token.text).push_back(' ');
  }
  text.back() = ';';
  return text;
}

// For each name, the declarations that use it, in order.
using Uses = std::unordered_map<std::string_view, std::vector<std::size_t>>;

Uses uses_in(const Tokens& tokens, const std::vector<Declaration>& declarations) {
  Uses found;
  for (std::size_t k = 0; k < declarations.size(); ++k) {
    for (std::size_t i = declarations[k].begin; i < declarations[k].end; ++i) {
      if (tokens[i].kind != Token::Kind::name) continue;
      if (i > 0 && (tokens[i - 1].is(".") || tokens[i - 1].is("->") || tokens[i - 1].is("::"))) {
        continue;
      }
      std::vector<std::size_t>& users = found[tokens[i].text];
      if (users.empty() || users.back() != k) users.push_back(k);
    }
  }
  return found;
}

// Leaves only the declarations before which a prototype of the function may have to stand: those
// up to the first that all that follows can see, or up to a prototype of the sketch's own.
void keep_first(std::vector<std::size_t>& users, const Tokens& tokens,
                const std::vector<Declaration>& declarations, std::string_view name) {
  std::vector<std::size_t> first;
  for (const std::size_t k : users) {
    const Declaration& declaration = declarations[k];
    const auto its = function_of(tokens, declaration);
    if (its && its->name == name) {
      if (declaration.head == tokens.size() || !tokens[declaration.head].is("{")) break;
      continue;  // an overload
    }
    first.push_back(k);
    if (declaration.conditions == 0) break;
  }
  users = std::move(first);
}

std::string line_directive(std::size_t line, std::string_view file) {
  std::string text = "#line " + std::to_string(line) + " \"";
  for (const char c : file) {
    if (c == '"' || c == '\\') text.push_back('\\');
    text.push_back(c);
  }
  return text + "\"\n";
}

// The files as one text. place() gives the file and line of an offset.
class Joined {
 public:
  explicit Joined(const std::vector<SketchFile>& files) : files_(files) {
    for (const SketchFile& file : files) {
      text_ += line_directive(1, file.name);
      starts_.push_back(text_.size());
      text_ += file.text + '\n';
    }
    for (std::size_t i = 0; i < text_.size(); ++i) {
      if (text_[i] == '\n') breaks_.push_back(i);
    }
  }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] std::string place(std::size_t offset) const {
    const auto behind = std::ranges::upper_bound(starts_, offset);
    const auto file = static_cast<std::size_t>(behind - starts_.begin()) - 1;
    const auto first = std::ranges::lower_bound(breaks_, starts_[file]);
    const auto here = std::ranges::lower_bound(breaks_, offset);
    return line_directive(static_cast<std::size_t>(here - first) + 1, files_[file].name);
  }

 private:
  const std::vector<SketchFile>& files_;
  std::vector<std::size_t> starts_, breaks_;
  std::string text_;
};

}  // namespace

std::string joined(const std::vector<SketchFile>& files) {
  const Joined whole(files);
  const Tokens tokens = Scanner(whole.text()).tokens();
  const std::vector<Declaration> declarations = declarations_of(tokens);
  Uses uses = uses_in(tokens, declarations);
  std::unordered_set<std::string_view> cut;       // names whose uses keep_first() has seen
  std::map<std::size_t, std::string> prototypes;  // by their offsets in the text
  for (std::size_t i = 0; i < declarations.size(); ++i) {
    const Declaration& declaration = declarations[i];
    if (declaration.head == tokens.size() || !tokens[declaration.head].is("{")) continue;
    const auto function = function_of(tokens, declaration);
    if (!function) continue;
    const std::string prototype = whole.place(tokens[declaration.begin].offset) +
                                  prototype_of(tokens, declaration, *function) + '\n';
    std::vector<std::size_t>& users = uses[function->name];
    if (cut.insert(function->name).second) keep_first(users, tokens, declarations, function->name);
    for (const std::size_t k : users) {
      if (k >= i) break;
      prototypes[tokens[declarations[k].begin].offset] += prototype;
    }
  }
  std::string source = "#include <Arduino.h>\n";
  std::size_t done = 0;
  for (const auto& [offset, text] : prototypes) {
    source.append(whole.text(), done, offset - done).append("\n" + text + whole.place(offset));
    done = offset;
  }
  return source.append(whole.text(), done);
}

std::vector<std::string> includes_of(const std::string& text) {
  std::vector<std::string> names;
  for (const Token& token : Scanner(text).tokens()) {
    if (token.kind != Token::Kind::directive) continue;
    const std::size_t word = token.text.find_first_not_of(" \t", 1);
    if (word == std::string_view::npos || !token.text.substr(word).starts_with("include")) continue;
    const std::size_t open = token.text.find_first_of("<\"", word);
    if (open == std::string_view::npos) continue;
    const std::size_t close = token.text.find(token.text[open] == '<' ? '>' : '"', open + 1);
    if (close != std::string_view::npos) {
      names.emplace_back(token.text.substr(open + 1, close - open - 1));
    }
  }
  return names;
}

}  // namespace bbsim::sketch
