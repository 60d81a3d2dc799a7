# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -D SOURCE=... -D BUILD=... -D COMPILER=... -P lint.cmake: cppcheck and clang-tidy over the sources of
# a configured build. The checks, and the omitted ones with the reason, are in .clang-tidy (tests/.clang-tidy
# for the tests) and cppcheck.txt.
cmake_minimum_required(VERSION 3.20)
find_program(CPPCHECK cppcheck REQUIRED)
find_program(CLANG_TIDY NAMES clang-tidy clang-tidy-14 REQUIRED)
find_program(RUN_CLANG_TIDY NAMES run-clang-tidy run-clang-tidy-14 REQUIRED)
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
set(folders libcontact formats tools tests)
list(JOIN folders "|" any_folder)
file(READ ${BUILD}/compile_commands.json commands)
set(mpi "")
if(commands MATCHES "-DRC_MPI=1") # the lint of the preset mpi also checks sources of builds with MPI
    set(mpi -DRC_MPI=1)
endif()

# Each source once, although the library is compiled twice and once more with the toys. Options that only gcc
# understands are removed, and gcc's omp.h is used, because clang's may be absent.
set(once "")
set(files "")
string(JSON last LENGTH "${commands}")
math(EXPR last "${last} - 1")
foreach(k RANGE ${last})
    string(JSON entry GET "${commands}" ${k})
    string(JSON file GET "${entry}" file)
    if(file IN_LIST files OR NOT file MATCHES "^${SOURCE}/(${any_folder})/")
        continue()
    endif()
    list(APPEND files ${file})
    set(extra "-I${BUILD}/lint -I${SOURCE}")
    if(NOT file MATCHES "/libcontact/(grid|ranks/mpi)\\.c$")
        string(APPEND extra " -include ${SOURCE}/cmake/analyzed.h")
    endif()
    file(STRINGS ${file} feature REGEX "^#define _[A-Z]+_SOURCE") # before the first included file
    if(feature MATCHES "(_[A-Z]+_SOURCE)")
        string(APPEND extra " -D${CMAKE_MATCH_1}=")
    endif()
    if(file MATCHES "^${SOURCE}/tests/")
        string(APPEND extra " -include ${SOURCE}/cmake/asserted.h")
    endif()
    string(REPLACE " -fcx-limited-range" "" entry "${entry}")
    string(REPLACE " -DNDEBUG" "" entry "${entry}") # assertions exclude impossible paths
    string(REPLACE " -c " " ${extra} -c " entry "${entry}")
    string(APPEND once "${entry},\n")
endforeach()
string(REGEX REPLACE ",\n$" "" once "${once}")
file(WRITE ${BUILD}/lint/compile_commands.json "[\n${once}\n]\n")
list(LENGTH files count)
execute_process(COMMAND ${COMPILER} -print-file-name=include/omp.h OUTPUT_VARIABLE omp OUTPUT_STRIP_TRAILING_WHITESPACE)
if(EXISTS "${omp}")
    file(READ ${omp} omp)
    string(REGEX REPLACE "__malloc__ \\(omp_free\\),?" "" omp "${omp}")
    file(WRITE ${BUILD}/lint/omp.h "${omp}")
endif()

# cppcheck 2.10 knows the attribute, not the keyword: otherwise it assumes that tool_die returns.
execute_process(COMMAND ${CPPCHECK} --std=c11 --enable=warning,performance,portability --library=posix
    --suppressions-list=${SOURCE}/cmake/cppcheck.txt --quiet --error-exitcode=1
    -j ${cores} -I . -D_XOPEN_SOURCE=700 "-DRC_VERSION=\"0\"" "-D_Noreturn=__attribute__((noreturn))" ${mpi} ${folders}
    WORKING_DIRECTORY ${SOURCE} RESULT_VARIABLE cppcheck)
execute_process(COMMAND ${RUN_CLANG_TIDY} -quiet -p ${BUILD}/lint -j ${cores} -clang-tidy-binary ${CLANG_TIDY}
    OUTPUT_FILE ${BUILD}/lint/clang-tidy.txt ERROR_FILE ${BUILD}/lint/clang-tidy.err RESULT_VARIABLE tidy)
if(NOT tidy EQUAL 0)
    execute_process(COMMAND grep -E "error:|warning:" ${BUILD}/lint/clang-tidy.txt)
endif()
if(NOT cppcheck EQUAL 0 OR NOT tidy EQUAL 0)
    message(FATAL_ERROR "findings, above: mend them, or say in .clang-tidy or cppcheck.txt why they are none")
endif()
list(JOIN folders ", " folders)
message(STATUS "${folders}: nothing found by cppcheck, nor by clang-tidy in ${count} sources and the headers they include")
