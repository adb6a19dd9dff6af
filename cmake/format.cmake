# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Targets format (rewrites the sources) and format-check (only reports). scripts/format selects the files.
add_custom_target(format COMMAND ${PROJECT_SOURCE_DIR}/scripts/format
                  COMMENT "Formatting the sources" VERBATIM)
add_custom_target(format-check COMMAND ${PROJECT_SOURCE_DIR}/scripts/format --check
                  COMMENT "Checking the formatting of the sources" VERBATIM)
