// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "slurm.hpp"

#include <string_view>

#include "base/shell_word.hpp"

namespace bbsim::app {
namespace {

// "gains.h5" and the number of a part become "gains-3of8.h5". merge() finds missing parts by such
// names.
struct PartName {
  std::string stem, ending;

  explicit PartName(const std::string& file) {
    const std::size_t dot = file.rfind('.');
    const std::size_t slash = file.rfind('/');
    const bool has_ending =
        dot != std::string::npos && (slash == std::string::npos || dot > slash + 1);
    stem = file.substr(0, has_ending ? dot : file.size());
    ending = has_ending ? file.substr(dot) : "";
  }

  // `number` is for a shell: $SLURM_ARRAY_TASK_ID in quotes, or a star.
  [[nodiscard]] std::string word(std::string_view number, std::size_t tasks) const {
    return shell_word(stem + '-') + std::string(number) +
           shell_word("of" + std::to_string(tasks) + ending);
  }
};

constexpr std::string_view task = "\"$SLURM_ARRAY_TASK_ID\"";

}  // namespace

std::string slurm_script(const SlurmJob& job) {
  const std::string tasks = std::to_string(job.tasks);
  const PartName part(job.output);
  const std::string merge =
      "bbsim merge " + part.word("*", job.tasks) + " -o " + shell_word(job.output);
  std::string text =
      "#!/bin/sh\n"
      "# A sweep of " +
      std::to_string(job.cases) + " cases as a Slurm job array of " + tasks +
      " tasks. Submit it from the folder\n"
      "# in which bbsim wrote it, because names of files are relative to that folder:\n"
      "#\n"
      "#   sbatch " +
      shell_word(job.script) +
      "\n"
      "#\n"
      "# A task that is queued again continues where it stopped. When all tasks are done, join "
      "their parts:\n"
      "#\n"
      "#   " +
      merge +
      "\n"
      "#\n"
      "# or let Slurm do it, with the number of the array's job in place of JOB:\n"
      "#\n"
      "#   sbatch --dependency=afterany:JOB --wrap=" +
      shell_word(merge) +
      "\n"
      "#\n"
      "#SBATCH --job-name=bbsim\n"
      "#SBATCH --array=1-" +
      tasks + "\n";
  if (job.threads > 0) text += "#SBATCH --cpus-per-task=" + std::to_string(job.threads) + '\n';
  text +=
      "#SBATCH --requeue\n"
      "#SBATCH --output=bbsim-%A_%a.log\n"
      "exec \"${BBSIM:-bbsim}\" sweep " +
      shell_word(job.scenario);
  for (const std::string& option : job.options) text += " \\\n  " + option;
  if (!job.summary.empty()) {
    text += " \\\n  --summary " + PartName(job.summary).word(task, job.tasks);
  }
  text += " \\\n  -j \"${SLURM_CPUS_PER_TASK:-1}\" --resume --shard " + std::string(task) + '/' +
          tasks + " \\\n  -o " + part.word(task, job.tasks) + '\n';
  return text;
}

}  // namespace bbsim::app
