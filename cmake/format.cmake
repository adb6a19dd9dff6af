# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Targets format (rewrites) and format-check (reports); which files and how, scripts/format says.
add_custom_target(format COMMAND ${PROJECT_SOURCE_DIR}/scripts/format
                  COMMENT "Formatting the sources" VERBATIM)
add_custom_target(format-check COMMAND ${PROJECT_SOURCE_DIR}/scripts/format --check
                  COMMENT "Checking the formatting of the sources" VERBATIM)
