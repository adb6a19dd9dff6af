# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Packages, by CPack (scripts/package). Each component that install() names is one: what names none is
# of the program. A component without a description here is not packaged.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/pages COMPONENT docs
        FILES_MATCHING PATTERN *.md PATTERN *.png)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/CITATION.cff
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT docs)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME bbsim)
set(CPACK_PACKAGE_VENDOR "the bbsim authors")
set(CPACK_PACKAGE_CONTACT "the bbsim authors <bbsim@localhost.invalid>" CACHE STRING
    "who packages are from, with an address for mail")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "simulator of a ball rolling on a tilting plate")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "bbsim simulates a ball that rolls on a plate which tilts about two axes, the
ball-and-plate rig of control courses, with the effects of real rigs: sampling,
delay, noise, limits of servos, backlash and friction. It runs single scenarios
and large sweeps, and takes controllers in any language.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME bbsim)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS libnlopt0) # loaded by bbsim tune
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "gnuplot-nox | gnuplot, g++, python3, octave, bbsim-doc")
set(CPACK_COMPONENT_DOCS_DESCRIPTION "The tutorials, how-to guides, references and explanations of bbsim, a simulator
of the ball-and-plate rig of control courses, as Markdown.")
set(CPACK_DEBIAN_DOCS_PACKAGE_NAME bbsim-doc)
set(CPACK_DEBIAN_DOCS_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCS_PACKAGE_SECTION doc)
set(CPACK_COMPONENTS_ALL program docs)

# What Debian's policy wants beside what any installation has.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian.cmake)
include(CPack)
