// Comments of a YAML text, made short.
#pragma once

#include <string>
#include <string_view>

namespace bbsim::yaml {

// The text with each comment that stands on a line of its own, from its first column, cut down to
// its
// "#": yaml-cpp looks at every character of a comment, with dozens of instructions for each. All
// else stays on its line and column. A text in which a quoted scalar might go on to the next line,
// where such a line would be part of it, is returned as it is.
[[nodiscard]] std::string with_short_comments(std::string_view text);

}  // namespace bbsim::yaml
