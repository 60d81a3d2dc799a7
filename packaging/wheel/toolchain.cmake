# SPDX-License-Identifier: GPL-3.0-or-later
# The compiler of this machine with the headers and libraries of an old Debian, in the folder $ROOT.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER gcc)
set(CMAKE_SYSROOT $ENV{ROOT})
set(CMAKE_FIND_ROOT_PATH $ENV{ROOT}/opt/rc $ENV{ROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(libraries $ENV{ROOT}/opt/rc/lib:$ENV{ROOT}/lib/x86_64-linux-gnu:$ENV{ROOT}/usr/lib/x86_64-linux-gnu)
# The build runs the tools, for their completions.
set(CMAKE_CROSSCOMPILING_EMULATOR $ENV{ROOT}/lib64/ld-linux-x86-64.so.2 --library-path ${libraries})
# The root's libgomp, not that of this machine's compiler; functions that nothing calls are left out.
set(CMAKE_C_FLAGS_INIT "-ffunction-sections -fdata-sections")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-L$ENV{ROOT}/opt/rc/lib -L$ENV{ROOT}/usr/lib/x86_64-linux-gnu -Wl,-rpath-link,${libraries} -static-libgcc -Wl,--gc-sections")
