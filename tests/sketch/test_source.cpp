// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A sketch's files as one source, and the search for libraries.
#include <filesystem>
#include <string>

#include "app/process.hpp"
#include "catch.hpp"
#include "sketch/compile.hpp"
#include "sketch/source.hpp"

namespace bbsim_test::test_source {

using bbsim::sketch::find_libraries;
using bbsim::sketch::includes_of;
using bbsim::sketch::joined;

namespace {

std::string of(const std::string& text) {
  return joined({{"a.ino", text}});
}

const std::string start = "#include <Arduino.h>\n#line 1 \"a.ino\"\n";

}  // namespace

TEST_CASE("a sketch that needs no prototypes is only concatenated") {
  const std::string text = "int f(int a) { return a; }\nvoid setup() { f(1); }\nvoid loop() {}\n";
  CHECK(of(text) == start + text + "\n");
  CHECK(joined({{"a \"b\".ino", "int a;"}, {"c.ino", "int b;"}}) ==
        "#include <Arduino.h>\n#line 1 \"a \\\"b\\\".ino\"\nint a;\n#line 1 \"c.ino\"\nint b;\n");
}

TEST_CASE("a function used before its definition gets a prototype before the use") {
  CHECK(
      of("struct P { int x; };\nvoid loop() { f({1}, 2); }\nint f(P p, int b = 3) { return b; "
         "}\n") ==
      start +
          "struct P { int x; };\n\n#line 3 \"a.ino\"\nint f ( P p , int b );\n#line 2 \"a.ino\"\n" +
          "void loop() { f({1}, 2); }\nint f(P p, int b = 3) { return b; }\n\n");
}

TEST_CASE("text that only resembles a function or a use gets no prototype") {
  const std::string text =
      GENERATE(as<std::string>{}, "void loop() { /* f(); */ } // f()\nvoid f() {}",
               "const char* t = \"f() { \"; char c = '{';\nvoid f() {}",
               "const char* t = R\"x(f() { )\" )x\";\nvoid f() {}",
               "void f(int);\nvoid loop() { f(1); }\nvoid f(int) {}",
               "void loop() { a.f(); b->f(); C::f(); }\nvoid f() {}",
               "void loop() { f(1); }\ntemplate <class T> void f(T) {}",
               "int loop() { f(); }\nauto f() { return 1; }", "void g() { f; }\nvoid C::f() {}",
               "void g() { v; }\nint v[] = {f(1)};", "#define X f() \\\n  f()\nvoid f() {}");
  CHECK(of(text) == start + text + "\n");
}

TEST_CASE("a prototype inside a conditional is repeated for uses outside") {
  const std::string made =
      of("#if A\nvoid g() { f(); }\n#endif\nvoid loop() { f(); }\nvoid f() {}\n");
  std::size_t count = 0;
  for (std::size_t at = 0; (at = made.find("void f ( );", at)) != std::string::npos; ++at) ++count;
  CHECK(count == 2);
}

TEST_CASE("includes are found, and nothing else") {
  CHECK(includes_of("#include <A.h>\n # include \"b/B.h\" // <C.h>\n// #include "
                    "<D.h>\n/*\n#include <E.h>\n*/") == std::vector<std::string>{"A.h", "b/B.h"});
}

TEST_CASE("libraries are found as in the IDE") {
  namespace fs = std::filesystem;
  const bbsim_test::Folder folder;
  const auto put = [&](const std::string& name, const std::string& text) {
    fs::create_directories(fs::path(folder / name).parent_path());
    folder.write(name, text);
  };
  put("sketch/own.h", "");
  put("sketch/own.cpp", "#include <Flat.h>");
  put("sketch/other.cpp", "");
  put("libs/Flat/Flat.h", "");
  put("libs/Flat/Flat.cpp", "#include \"Deep.h\"");
  put("libs/Flat/examples/e.cpp", "");
  put("libs/Other_Name/src/Deep.h", "");
  put("libs/Other_Name/src/part/more.c", "");
  put("libs/Unused/Unused.h", "");
  put("libs/Unused/Unused.cpp", "");
  put("ours/Servo.h", "");
  put("libs/Servo/Servo.h", "");
  const auto found = find_libraries({"own.h", "Servo.h", "none.h"}, {folder / "sketch"},
                                    {folder / "libs"}, folder / "ours");
  CHECK(found.folders ==
        std::vector<std::string>{folder / "libs/Flat", folder / "libs/Other_Name/src"});
  CHECK(found.sources == std::vector<std::string>{folder / "sketch/own.cpp",
                                                  folder / "libs/Flat/Flat.cpp",
                                                  folder / "libs/Other_Name/src/part/more.c"});
  CHECK(find_libraries({"Flat.h"}, {}, {folder / "libs/Flat"}, "").sources.size() == 1);
  // A whole folder, but not its copy of what the board has.
  put("sketch/Servo.cpp", "");
  put("sketch/src/deep/x.c", "");
  CHECK(find_libraries({}, {folder / "sketch"}, {}, folder / "ours", {folder / "sketch"}).sources ==
        std::vector<std::string>{folder / "sketch/other.cpp", folder / "sketch/own.cpp",
                                 folder / "sketch/src/deep/x.c"});
}

TEST_CASE("a sketch of many functions is read once, not once for each") {
  std::string text = "void setup() { f99999(); }\n";
  for (int i = 0; i < 100000; ++i) {
    text += "void f" + std::to_string(i) + "() { f" + std::to_string((i * 7 + 1) % 100000) +
            "(); }\n#define A" + std::to_string(i) + "\n";
  }
  const std::string source = of(text);
  CHECK(source.find("\nvoid f99999 ( );\n#line 1 \"a.ino\"\nvoid setup()") != std::string::npos);
}

}  // namespace bbsim_test::test_source
