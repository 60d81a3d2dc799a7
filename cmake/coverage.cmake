# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -D SOURCE=... -D BUILD=... -P coverage.cmake: runs the tests of a build with RC_COVERAGE. For each
# file it prints how many lines of libcontact and formats they have run. BUILD/coverage.txt has the numbers of
# the other lines.
find_program(GCOVR gcovr REQUIRED)
file(GLOB_RECURSE counts ${BUILD}/*.gcda)
if(counts)
    file(REMOVE ${counts})
endif()
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
# Omitted: tests that link programs without counters, and tests that limit memory or make allocations fail,
# because the counters need memory too.
execute_process(COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${BUILD} --parallel ${cores} --output-on-failure
                -E "^pipe_(installed|library|memory|allocations)$" RESULT_VARIABLE failed)
# Runs the tests of sandboxed readers again without a sandbox (unsandboxed.c). Their checks of the sandbox
# fail in this run; for these the run above counts.
set(ENV{RC_UNSANDBOXED} 1)
execute_process(COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${BUILD} --parallel ${cores} -R "^format_(hdf5|datx|tiff|park)$"
                OUTPUT_QUIET)
set(uncounted --exclude ${SOURCE}/formats/sandbox/confine.c --exclude ${SOURCE}/formats/sandbox/calls.c) # unreached.txt
# Lines that tests/toys runs in its copy of libcontact count too.
execute_process(COMMAND ${GCOVR} --root ${SOURCE} --filter ${SOURCE}/libcontact/ --filter ${SOURCE}/formats/ ${uncounted}
    --gcov-ignore-parse-errors --sort-percentage --txt ${BUILD}/coverage.txt ${BUILD} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND tail -n 4 ${BUILD}/coverage.txt)
file(READ ${SOURCE}/cmake/unreached.txt unreached)
message("${unreached}")
foreach(folder libcontact formats)
    execute_process(COMMAND ${GCOVR} --root ${SOURCE} --filter ${SOURCE}/${folder}/ ${uncounted} --gcov-ignore-parse-errors
        --fail-under-line 95 --txt ${BUILD}/coverage-${folder}.txt ${BUILD} RESULT_VARIABLE under)
    if(NOT under EQUAL 0)
        list(APPEND short ${folder})
    endif()
endforeach()
if(short OR NOT failed EQUAL 0)
    message(FATAL_ERROR "under 95 % of the lines: ${short}; tests failed: ${failed}")
endif()
