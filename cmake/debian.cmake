# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# CPack runs this before it packs the Debian packages, when their files are in its folder. Adds a
# changelog and a copyright to each, compresses man pages, and removes build paths from programs.
function(compress file)
  execute_process(COMMAND gzip -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

execute_process(COMMAND ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/program/usr/bin/bbsim --licenses
                OUTPUT_VARIABLE _licenses COMMAND_ERROR_IS_FATAL ANY)
string(TIMESTAMP _date "%a, %d %b %Y %H:%M:%S +0000" UTC) # or SOURCE_DATE_EPOCH, if set
set(_version ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
foreach(_component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${_component} _upper)
  set(_package ${CPACK_DEBIAN_${_upper}_PACKAGE_NAME})
  set(_root ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${_component}/usr)
  set(_doc ${_root}/share/doc/${_package})
  file(WRITE ${_doc}/changelog.Debian
"bbsim (${_version}) unstable; urgency=medium

  * Version ${CPACK_PACKAGE_VERSION}; CHANGELOG.md of bbsim-doc has what is new.

 -- ${CPACK_PACKAGE_CONTACT}  ${_date}
")
  compress(${_doc}/changelog.Debian)
  file(WRITE ${_doc}/copyright "${_licenses}")
  file(CHMOD ${_doc}/copyright ${_doc}/changelog.Debian.gz PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  file(REMOVE ${_root}/share/doc/bbsim/LICENSE) # copyright contains it

  file(GLOB _pages ${_root}/share/man/man1/*.1)
  foreach(_page IN LISTS _pages)
    compress(${_page})
  endforeach()
  # Debian's Python uses one folder for all versions.
  file(GLOB _python ${_root}/lib/python3.*)
  if(_python)
    file(RENAME ${_python} ${_root}/lib/python3)
    file(GLOB _site ${_root}/lib/python3/site-packages)
    if(_site)
      file(RENAME ${_site} ${_root}/lib/python3/dist-packages)
    endif()
  endif()
  file(GLOB _modules ${_root}/lib/bbsim/* ${_root}/lib/libbbsim.so.*.*.*)
  foreach(_module IN LISTS _modules)
    file(RPATH_REMOVE FILE ${_module})
  endforeach()
endforeach()
