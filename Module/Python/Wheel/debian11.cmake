# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# CMake toolchain file: the machine's compiler with the C and C++ libraries of Debian 11, which lie in the
# folder SPLATTINGMIP_DEBIAN11 of the environment. auditwheel checks that only symbols of glibc 2.28 are used.
set(root "$ENV{SPLATTINGMIP_DEBIAN11}")
set(CMAKE_FIND_ROOT_PATH "${root}")
execute_process(COMMAND gcc -print-multiarch OUTPUT_VARIABLE arch OUTPUT_STRIP_TRAILING_WHITESPACE)
set(CMAKE_C_FLAGS_INIT "--sysroot=${root}")
set(CMAKE_CXX_FLAGS_INIT
  "--sysroot=${root} -nostdinc++ -isystem ${root}/usr/include/c++/10 -isystem ${root}/usr/include/${arch}/c++/10 $ENV{SPLATTINGMIP_CXXFLAGS}")
foreach (kind IN ITEMS EXE SHARED MODULE)
  set("CMAKE_${kind}_LINKER_FLAGS_INIT"
    "-L${root}/usr/lib/gcc/${arch}/10 -L${root}/usr/lib/${arch} -L${root}/lib/${arch} -Wl,--as-needed")
endforeach ()
set(CMAKE_CXX_COMPILER_LAUNCHER ccache CACHE STRING "")
set(CMAKE_POLICY_VERSION_MINIMUM 3.5 CACHE STRING "") # of Debian 11's GLM
set(glm_DIR "${root}/usr/lib/cmake/glm" CACHE PATH "")
