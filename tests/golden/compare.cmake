# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Runs SCENARIO as a user would, with a row every 0.1 s, and compares it with its golden CSV.
#
# A golden file is the solution at rtol 1e-13 (regenerate.sh), not the result of one method at its default tolerance.
# Any method that meets rtol 1e-8 passes, because the global error may be a hundred times that.
get_filename_component(name ${SCENARIO} NAME_WE)
execute_process(COMMAND ${BBSIM} run ${SCENARIO} -q --set time.step=0.1 -o ${name}.golden-test.csv
                RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "bbsim run ended with ${failed}")
endif()
execute_process(COMMAND ${BBSIM} compare ${name}.golden-test.csv ${GOLDEN} --rtol 1e-6 --atol 1e-6
                RESULT_VARIABLE differ)
if(differ)
  message(FATAL_ERROR "bbsim compare ended with ${differ}")
endif()
