# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -D SOURCE=... -D OUT=... -D NAME=libcontact-1.2.3 -P dist.cmake: writes OUT/NAME.tar.gz with the
# current tree: the files that git tracks or, without git, all files except build products.
get_filename_component(OUT "${OUT}" ABSOLUTE)
get_filename_component(SOURCE "${SOURCE}" ABSOLUTE)
find_program(GIT git)
set(files "")
if(GIT AND EXISTS ${SOURCE}/.git)
    execute_process(COMMAND ${GIT} ls-files WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE files
                    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    string(REPLACE "\n" ";" files "${files}")
else()
    file(GLOB_RECURSE files LIST_DIRECTORIES false RELATIVE ${SOURCE} ${SOURCE}/*)
    list(FILTER files EXCLUDE REGEX "^build|^obj-|^\\.git/|^\\.cache/|__pycache__")
    list(FILTER files EXCLUDE REGEX "^debian/([^/]*/(usr|DEBIAN)/|\\.debhelper/|files$|.*(substvars|debhelper.*|stamp)$)")
endif()
list(SORT files)

set(stage ${OUT}/dist)
file(REMOVE_RECURSE ${stage})
foreach(file IN LISTS files)
    if(NOT EXISTS ${SOURCE}/${file})
        message(FATAL_ERROR "${file} is in git and not in the tree: commit its removal, or bring it back")
    endif()
    get_filename_component(folder ${file} DIRECTORY)
    file(COPY ${SOURCE}/${file} DESTINATION ${stage}/${NAME}/${folder})
endforeach()
execute_process(COMMAND ${CMAKE_COMMAND} -E tar czf ${OUT}/${NAME}.tar.gz --format=gnutar ${NAME}
                WORKING_DIRECTORY ${stage} COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE_RECURSE ${stage})
list(LENGTH files n)
message(STATUS "${OUT}/${NAME}.tar.gz: ${n} files")
