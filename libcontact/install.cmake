# SPDX-License-Identifier: GPL-3.0-or-later
# The library installed, and what tells others where it is: libcontact.pc for pkg-config and a package for
# find_package. Neither holds the prefix of the build, so that both are right wherever they stand.
include(CMakePackageConfigHelpers)
# What the static library needs: by their pkg-config files, and where there is none by their names.
set(modules fftw3 fftw3f gsl)
set(by_name fftw3_threads fftw3f_threads)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/libcontact)

set(headers grid.h surface.h model.h scene.h contact.h)
if(RC_MPI)
    list(APPEND headers contact_mpi.h)
    set(libraries_of_mpi ${MPI_C_LIB_NAMES})
endif()
install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/libcontact)
foreach(kind shared static)
    install(TARGETS contact_${kind} EXPORT libcontact-${kind}
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
            INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()
set_target_properties(contact_shared PROPERTIES EXPORT_NAME contact)

# ---- pkg-config ----

# pc_dir DIR: what stands for it in libcontact.pc, where a backslash keeps a blank.
function(pc_dir out dir)
    if(IS_ABSOLUTE "${dir}")
        string(REPLACE " " "\\ " dir "${dir}")
    else()
        set(dir "\${prefix}/${dir}")
    endif()
    set(${out} "${dir}" PARENT_SCOPE)
endfunction()
pc_dir(pc_libdir "${CMAKE_INSTALL_LIBDIR}")
pc_dir(pc_includedir "${CMAKE_INSTALL_INCLUDEDIR}")
list(JOIN modules " " pc_requires)
set(pc_libs ${by_name} ${libraries_of_mpi} ${OpenMP_C_LIB_NAMES} m)
list(TRANSFORM pc_libs PREPEND "-l")
list(JOIN pc_libs " " pc_libs)
set(pc ${CMAKE_CURRENT_BINARY_DIR}/libcontact.pc)
if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
    # From there no way leads to the prefix. Which one it is, is known when it is installed.
    set(package_dir lib/cmake/libcontact)
    set(pc_prefix "@prefix@")
    configure_file(libcontact.pc.in ${pc}.in @ONLY)
    install(CODE "get_filename_component(prefix \"\${CMAKE_INSTALL_PREFIX}\" ABSOLUTE)
    string(REPLACE \" \" \"\\\\ \" prefix \"\${prefix}\")
    configure_file(\"${pc}.in\" \"${pc}\" @ONLY)")
else()
    file(RELATIVE_PATH up "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
    string(REGEX REPLACE "/$" "" up "${up}")
    set(pc_prefix "\${pcfiledir}/${up}")
    configure_file(libcontact.pc.in ${pc} @ONLY)
endif()
install(FILES ${pc} DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# ---- find_package ----

foreach(kind shared static)
    install(EXPORT libcontact-${kind} NAMESPACE libcontact:: DESTINATION ${package_dir})
endforeach()
set(config ${CMAKE_CURRENT_BINARY_DIR}/libcontact-config)
configure_package_config_file(libcontact-config.cmake.in ${config}.cmake INSTALL_DESTINATION ${package_dir}
                              NO_SET_AND_CHECK_MACRO)
# A request is met by the versions that have the same soname.
if(PROJECT_VERSION_MAJOR EQUAL 0)
    set(compatible SameMinorVersion)
else()
    set(compatible SameMajorVersion)
endif()
write_basic_package_version_file(${config}-version.cmake COMPATIBILITY ${compatible})
install(FILES ${config}.cmake ${config}-version.cmake DESTINATION ${package_dir})
