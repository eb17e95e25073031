# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# For the folder Remote of VTK's sources: VTK_MODULE_ENABLE_VTK_RenderingSplattingMIP=YES fetches and
# builds both modules. In VTK's repository a URL and a commit replace the two variables. VTK does not
# fetch again what a branch names: a full hash does.
set(SPLATTINGMIP_GIT_REPOSITORY "" CACHE STRING "URL or folder of a Git repository of SplattingMIP")
set(SPLATTINGMIP_GIT_TAG "HEAD" CACHE STRING
  "Commit of SplattingMIP to build. Only a full hash updates a repository that has been fetched")
if (NOT SPLATTINGMIP_GIT_REPOSITORY)
  if (VTK_MODULE_ENABLE_VTK_RenderingSplattingMIP MATCHES "^(YES|WANT)$")
    message(FATAL_ERROR "There is no repository to fetch VTK::RenderingSplattingMIP from: set "
      "SPLATTINGMIP_GIT_REPOSITORY to the URL or the folder of a Git repository of SplattingMIP.")
  endif ()
  return() # VTK_BUILD_ALL_MODULES would fetch it, too
endif ()
vtk_fetch_module(RenderingSplattingMIP
  "Maximum intensity projections by splatting in sheared object space"
  GIT_REPOSITORY "${SPLATTINGMIP_GIT_REPOSITORY}"
  GIT_TAG "${SPLATTINGMIP_GIT_TAG}")
