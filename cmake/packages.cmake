# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Packages by CPack (scripts/package), one per component of install(); the default component is the
# program. A component without a description here is not packaged.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/pages COMPONENT docs
        FILES_MATCHING PATTERN *.md PATTERN *.png)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/CITATION.cff
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT docs)
install(CODE "
  set(BBSIM_SOURCE \"${PROJECT_SOURCE_DIR}\")
  set(BBSIM_PREFIX \"\${CMAKE_INSTALL_PREFIX}\")
  set(BBSIM_DOC_DIR \"${CMAKE_INSTALL_DOCDIR}\")
  set(BBSIM_DATA_DIR \"${CMAKE_INSTALL_DATADIR}\")
  set(BBSIM_INCLUDE_DIR \"${CMAKE_INSTALL_INCLUDEDIR}\")
  include(\"${PROJECT_SOURCE_DIR}/cmake/installed_links.cmake\")" COMPONENT docs)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME bbsim)
set(CPACK_PACKAGE_VENDOR "the bbsim authors")
set(CPACK_PACKAGE_CONTACT "the bbsim authors <bbsim@localhost.invalid>" CACHE STRING
    "who the packages are from, with an email address")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "simulator of a ball rolling on a tilting plate")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "bbsim simulates a ball that rolls on a plate which tilts about two axes, the
ball-and-plate rig of control courses, with the effects of real rigs: sampling,
delay, noise, limits of servos, backlash and friction. It runs single scenarios
and large sweeps, and takes controllers in any language.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME bbsim)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "python3-bbsim, g++, python3, octave, bbsim-doc")
set(CPACK_COMPONENT_DOCS_DESCRIPTION "The tutorials, how-to guides, references and explanations of bbsim, a simulator
of the ball-and-plate rig of control courses, as Markdown.")
set(CPACK_DEBIAN_DOCS_PACKAGE_NAME bbsim-doc)
set(CPACK_DEBIAN_DOCS_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCS_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCS_PACKAGE_RECOMMENDS bbsim) # the pages link to its examples

# The C++ library and its development files. As for any Debian library, the name contains the version.
set(_library libbbsim${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(_same "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "The C++ library of bbsim, a simulator of the ball-and-plate rig of control
courses. It reads and writes HDF5 files if the package bbsim is installed.")
file(WRITE ${PROJECT_BINARY_DIR}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/triggers)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${_library})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "bbsim ${_same}")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Development files of the C++ library of bbsim, a simulator
of the ball-and-plate rig of control courses: the header, the static library,
and files for CMake and pkg-config.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libbbsim-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${_library} ${_same}")
set(CPACK_COMPONENTS_ALL program docs library development)
if(TARGET bbsim_python)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The Python package of bbsim, a simulator of the ball-and-plate rig of control
courses: runs, sweeps and linear models in the process, with numpy arrays,
environments for learning, and the commands `bbsim plot`, `fit`, `tune` and
`design`.
It reads and writes HDF5 files if the package bbsim is installed.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-bbsim)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  execute_process(COMMAND ${PYTHON_EXECUTABLE} -c "import sys; v = sys.version_info; print(f'python3 (>= {v[0]}.{v[1]}~), python3 (<< {v[0]}.{v[1] + 1})', end='')"
                  OUTPUT_VARIABLE _python_version COMMAND_ERROR_IS_FATAL ANY)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${_python_version}, python3-numpy")
  # For bbsim plot; and for fit, tune and design. They are ten times as large as the rest.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "bbsim ${_same}, python3-matplotlib, python3-scipy")
  # Files that Python compiles belong to the package.
  set(_scripts ${PROJECT_BINARY_DIR}/python/scripts)
  file(WRITE ${_scripts}/postinst "#!/bin/sh\nset -e\nif [ \"$1\" = configure ]; then py3compile -p python3-bbsim; fi\n")
  file(WRITE ${_scripts}/prerm "#!/bin/sh\nset -e\npy3clean -p python3-bbsim\n")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${_scripts}/postinst ${_scripts}/prerm)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()

# What Debian's policy requires beyond other installations.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian.cmake)
include(CPack)
