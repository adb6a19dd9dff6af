// The names of measures.
#include "base/error.hpp"
#include "catch.hpp"
#include "scenario/measures.hpp"

using namespace bbsim::scenario;
using Kind = Measure::Kind;

TEST_CASE("measures have names in SI, whatever the units they were given in") {
  const auto name = [](const char* text) {
    const auto measure = find_measure(text);
    return measure ? measure->name : "none";
  };
  CHECK(name("x.RiseTime") == "x.RiseTime");
  CHECK(name("when x=5 cm") == "when x=0.05 cross=1");
  CHECK(name(" when x = 5 cm  rise=2 ") == "when x=0.05 rise=2");
  CHECK(name("when phi=-1e-3 fall=last") == "when phi=-0.001 fall=last");
  CHECK(name("when tracking_error stays below 2 mm") == "when tracking_error stays below 0.002");
  CHECK(name("find vy when x stays above 0.1") == "find vy when x stays above 0.1");
  CHECK(name("find y at 20 ms") == "find y at 0.02");
  for (const char* wrong : {"x.Risetime",
                            "z.RiseTime",
                            "ball_qw.Peak",
                            "RiseTime",
                            "when x",
                            "when x=",
                            "when z=1",
                            "when x=1 rise=0",
                            "when x=1 rise=-1",
                            "when x=1 rise=one",
                            "when x=5 deg",
                            "when x=nan",
                            "when x stays 1",
                            "when x stays below",
                            "find x",
                            "find x at",
                            "find x at 5 cm",
                            "find z at 1",
                            "find x of y",
                            "find ball_qw at 1",
                            "max_",
                            "when",
                            "find"}) {
    CAPTURE(wrong);
    CHECK_FALSE(find_measure(wrong));
  }
}

TEST_CASE("measures have units and meanings, and know what they need") {
  CHECK(find_measure("x.RiseTime")->unit() == "s");
  CHECK(find_measure("x.Overshoot")->unit() == "%");
  CHECK(find_measure("x.Peak")->unit() == "m");
  CHECK(find_measure("when phi=1")->unit() == "s");
  CHECK(find_measure("find phi when x=1")->unit() == "rad");
  CHECK(find_measure("max_tilt")->unit() == "rad");
  CHECK(find_measure("x.Peak")->meaning() ==
        "largest size of: contact point along the plane's x axis");
  CHECK(find_measure("find x at 2")->meaning() == "at 2: contact point along the plane's x axis");
  CHECK(any_needs({*find_measure("find x when normal_force=0.1")}, Needs::dynamics));
  bbsim::Scenario open;
  CHECK(missing(*find_measure("find x when tracking_error=1 mm"), open));
  CHECK_FALSE(missing(*find_measure("when x=1"), open));
  CHECK(split_measures({"x.Peak, max_x", "when x=1"}) ==
        std::vector<std::string>{"x.Peak", "max_x", "when x=1"});
  CHECK_THROWS_AS(measures_named({"when x=1 cm", "when x=0.01"}, open), bbsim::InputError);
}

TEST_CASE("a measure that is none has a hint at the one that was meant") {
  CHECK(measure_hint("x.RizeTime") == " (did you mean x.RiseTime?)");
  CHECK(measure_hint("x.risetime") == " (did you mean x.RiseTime?)");
  CHECK(measure_hint(" max_titl") == " (did you mean max_tilt?)");
  CHECK(measure_hint("x") == " (did you mean end_x?)");
  CHECK(measure_hint("ball_qw") == "");
  CHECK(measure_hint("nothing like that") == "");
  const std::string_view columns[] = {"t", "level"};
  CHECK(measure_hint("max_levle", columns) == " (did you mean max_level?)");
  CHECK(measure_hint("max_titl", columns) == "");
}
