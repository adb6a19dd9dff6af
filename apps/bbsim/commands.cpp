#include "commands.hpp"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "controller/host.hpp"
#include "describe.hpp"

namespace bbsim::app {

void add_scenario(CLI::App& command, ScenarioArguments& arguments) {
  command.add_option("SCENARIO", arguments.file, "a YAML file; - is standard input")->required();
  add_overrides(command, arguments.overrides);
}

void add_overrides(CLI::App& command, std::vector<std::string>& overrides) {
  may_be_repeated(*command
                       .add_option("--set", overrides,
                                   "set a key of the scenario, such as ball.radius=0.02; may be "
                                   "given again")
                       ->type_name("KEY=VALUE"));
}

std::string default_output(const std::string& scenario, const std::string& suffix) {
  if (scenario == "-") return "-";
  return std::filesystem::path(scenario).stem().string() + suffix;
}

std::string name_of_output(const std::string& output) {
  return output == "-" ? "standard output" : output;
}

CLI::Validator whole_number(double least, double most) {
  const auto fault = [least, most](const std::string& text) -> std::string {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool number = error == std::errc() && end == text.data() + text.size();
    if (number && value >= least && value <= most && value == std::floor(value)) return "";
    return "found " + text + "; allowed: a whole number from " + short_number(least) +
           (most < largest_whole ? " to " + short_number(most) : " up");
  };
  return {fault, ""};  // without a description, which help would show for the option's type
}

void add_error(CLI::App& command, std::string& error) {
  command
      .add_option("--error", error,
                  "bound on the error of x and y at all output times, such as 1e-9 or \"1 um\"; "
                  "instead of solver.rtol and solver.atol, also of those in the scenario")
      ->type_name("E");
}

void reads_scenario(file::Outputs& outputs, const std::string& file,
                    const std::vector<std::string>& tables) {
  outputs.reads(file, "the scenario");
  for (const std::string& table : tables) outputs.reads(table, "a table of the scenario");
}

void reads_controller(file::Outputs& outputs, const Scenario& scenario) {
  for (const std::string& file : controller::files_of(scenario)) {
    outputs.reads(file, "the scenario's controller");
  }
}

void prints(file::Outputs& outputs) {
  outputs.writes("-", "what is printed");
}

void may_be_repeated(CLI::Option& option) {
  option.take_all()->expected(1)->allow_extra_args(false);
}

}  // namespace bbsim::app
