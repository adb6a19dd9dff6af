#include "commands.hpp"

namespace bbsim::app {

void add_scenario(CLI::App& command, ScenarioArguments& arguments) {
  command.add_option("SCENARIO", arguments.file, "YAML scenario")->required();
  may_be_repeated(
      *command.add_option("--set", arguments.overrides,
                          "key.path=value: set a key of the scenario; may be given again"));
}

void reads_scenario(record::Outputs& outputs, const std::string& file,
                    const std::vector<std::string>& tables) {
  outputs.reads(file, "the scenario");
  for (const std::string& table : tables) outputs.reads(table, "a table of the scenario");
}

void prints(record::Outputs& outputs) {
  outputs.writes("-", "what is printed");
}

void may_be_repeated(CLI::Option& option) {
  option.take_all()->expected(1)->allow_extra_args(false);
}

}  // namespace bbsim::app
