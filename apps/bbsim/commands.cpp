#include "commands.hpp"

namespace bbsim::app {

void add_scenario(CLI::App& command, ScenarioArguments& arguments) {
  command.add_option("SCENARIO", arguments.file, "YAML scenario")->required();
  command
      .add_option("--set", arguments.overrides,
                  "key.path=value: set a key of the scenario; may be given again")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);  // what follows may be the scenario
}

}  // namespace bbsim::app
