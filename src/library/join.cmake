# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# cmake -DLINKER=LD -DOBJCOPY=PROGRAM -DNM=PROGRAM -DOBJECT=FILE "-DARCHIVES=FILE|FILE" -DINTO=FILE -P join.cmake: links
# the object with what it needs of the archives into one object, which defines no global name but those of the API.
string(REPLACE "|" ";" ARCHIVES "${ARCHIVES}")
set(_made ${INTO}.tmp)

# Inline functions stand in groups, of which the linker of a program keeps the first; a group's name that is local would
# refer into a group of another. So groups become plain sections.
execute_process(COMMAND ${LINKER} -r --force-group-allocation -o ${_made} ${OBJECT} --start-group ${ARCHIVES} --end-group
                COMMAND_ERROR_IS_FATAL ANY)

# GCC marks variables of inline functions as unique in the process, which objcopy makes local only if they are weak.
execute_process(COMMAND ${NM} --defined-only ${_made} OUTPUT_VARIABLE _names COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL " u [^\n]+" _unique "${_names}")
list(TRANSFORM _unique REPLACE "^ u " "")
list(REMOVE_DUPLICATES _unique)
list(JOIN _unique "\n" _unique)
file(WRITE ${INTO}.unique "${_unique}\n")
execute_process(COMMAND ${OBJCOPY} --weaken-symbols=${INTO}.unique ${_made} COMMAND_ERROR_IS_FATAL ANY)

# bbsim::v0, with its typeinfo and vtables, as in exports.map.
execute_process(COMMAND ${OBJCOPY} --wildcard --keep-global-symbol=_ZN5bbsim2v0* --keep-global-symbol=_ZNK5bbsim2v0*
                        --keep-global-symbol=_ZT[ISV]N5bbsim2v0* ${_made} COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${_made} ${INTO})
