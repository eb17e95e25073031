# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# What the targets of a CMake package of VTK are in VTK's wheel from PyPI; build-wheel.sh puts it in place of
# the package's own list of libraries, from where VTK-targets.cmake includes it.

# All that other packages would define. Nothing of them is linked: the wheel brings what it needs.
file(STRINGS "${CMAKE_CURRENT_LIST_DIR}/VTK-targets.cmake" lines REGEX "INTERFACE_LINK_LIBRARIES")
string(REGEX MATCHALL "[A-Za-z0-9_-]+::[A-Za-z0-9_-]+" targets "${lines}")
list(REMOVE_DUPLICATES targets)
foreach (target IN LISTS targets)
  if (NOT target MATCHES "^(VTK|Python3|Threads)::" AND NOT TARGET "${target}")
    add_library("${target}" INTERFACE IMPORTED)
  endif ()
endforeach ()

# libvtkCommonCore-9.3.so is VTK::CommonCore, libvtksys.so is VTK::vtksys, and
# libvtkWrappingPythonCore3.11.so is VTK::WrappingPythonCore.
file(GLOB libraries "$ENV{SPLATTINGMIP_VTK_WHEEL}/vtkmodules/libvtk*.so")
foreach (library IN LISTS libraries)
  get_filename_component(file "${library}" NAME)
  if (NOT file MATCHES "^libvtk([A-Za-z0-9_]+)(3\\.[0-9]+)?(-[0-9.]+)?\\.so$")
    continue ()
  endif ()
  set(target "VTK::${CMAKE_MATCH_1}")
  if (NOT TARGET "${target}")
    set(target "VTK::vtk${CMAKE_MATCH_1}")
  endif ()
  if (NOT TARGET "${target}")
    continue ()
  endif ()
  get_target_property(type "${target}" TYPE)
  if (type STREQUAL "SHARED_LIBRARY")
    set_target_properties("${target}" PROPERTIES
      IMPORTED_LOCATION "${library}"
      IMPORTED_SONAME "${file}")
  elseif (type STREQUAL "INTERFACE_LIBRARY")
    # Debian's VTK takes it from another package; the wheel has its own.
    set_property(TARGET "${target}" PROPERTY INTERFACE_LINK_LIBRARIES "${library}")
  endif ()
endforeach ()

foreach (tool IN ITEMS WrapHierarchy WrapPython WrapPythonInit)
  set_property(TARGET "VTK::${tool}" PROPERTY IMPORTED_LOCATION "$ENV{SPLATTINGMIP_VTK_TOOLS}/${tool}")
endforeach ()
