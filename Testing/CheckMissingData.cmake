# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# cmake -DTESTS=PROGRAM [-DPAPER=PROGRAM] [-DBENCHMARK=PROGRAM] -DFOLDER=DIR -P CheckMissingData.cmake
#
# Runs what reads data with a folder that has none: each must name what it leaves out, tests must
# return VTK_SKIP_RETURN_CODE, and nothing may crash.
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}/empty")
set(ENV{SPLATTINGMIP_TEST_SCENES} 1)

# expect(CODE NAMED COMMAND...)
function (expect code named)
  execute_process(
    COMMAND ${ARGN}
    RESULT_VARIABLE result
    OUTPUT_VARIABLE output
    ERROR_VARIABLE output)
  string(FIND "${output}" "${named}" found)
  if (NOT result STREQUAL code OR found EQUAL -1)
    string(REPLACE ";" " " command "${ARGN}")
    message(SEND_ERROR "ERROR: '${command}' returns ${result}, not ${code}, or does not say "
      "'${named}'. It says:\n${output}")
  endif ()
endfunction ()

set(skipped 125) # VTK_SKIP_RETURN_CODE
set(data --demo-data "${FOLDER}/empty" --test-data "${FOLDER}/empty")
foreach (scene IN ITEMS
    aorta=aorta-stent.vti head=headsq.vti protein=ironProt.vtk aortaperspective=aorta-stent.vti
    aortainside=aorta-stent.vti proteinwide=ironProt.vtk)
  string(REPLACE "=" ";" scene "${scene}")
  list(GET scene 0 name)
  list(GET scene 1 file)
  expect(${skipped} "skipped: no data (${file})"
    "${TESTS}" TestMIPImage --scene ${name} --mode standard ${data})
endforeach ()
foreach (picture IN ITEMS 1=aorta-stent.vti 2=headsq.vti)
  string(REPLACE "=" ";" picture "${picture}")
  list(GET picture 0 number)
  list(GET picture 1 file)
  set(ENV{SPLATTINGMIP_TEST_SCENE} "pictures/${number}")
  expect(${skipped} "skipped: no data (${file})" "${TESTS}" TestExactPictures ${data})
endforeach ()
if (PAPER)
  expect(0 "" "${PAPER}" --quick "--data=${FOLDER}/empty" "--out=${FOLDER}/paper")
  file(READ "${FOLDER}/paper/report.md" report)
  if (NOT report MATCHES "ultrasound volume was skipped: there is no spine-phantom-ultrasound.mha")
    message(SEND_ERROR "ERROR: the paper's report does not say that it lacks the ultrasound volume.")
  endif ()
endif ()
if (BENCHMARK)
  expect(0 "skipped: no data for lidc0314-int16 (${FOLDER}/empty/lidc-idri-0314.nrrd)"
    "${BENCHMARK}" "--data=${FOLDER}/empty" --benchmark_list_tests)
  expect(0 "vessels64-uint8" "${BENCHMARK}" "--data=${FOLDER}/empty" --quick)
endif ()
