# Runs `splatmip-paper --quick` and looks whether its report is complete:
#   cmake -DPROGRAM=... -DFOLDER=... -P CheckPaperReport.cmake
file(REMOVE_RECURSE "${FOLDER}")
execute_process(
  COMMAND "${PROGRAM}" --quick "--out=${FOLDER}"
  RESULT_VARIABLE result)
if (NOT result EQUAL 0)
  message(FATAL_ERROR "ERROR: splatmip-paper has failed.")
endif ()

file(READ "${FOLDER}/report.md" report)
foreach (section IN ITEMS
    "Data" "Tables 1 to 4: times" "Ratios of the mean times" "Table 5: memory"
    "Figure 10: the modes" "Figure 11: the methods" "Figure 12: line encoding"
    "Figure 13: two resolutions" "Accuracy")
  # A section is its heading and something below that is not the next heading.
  if (NOT report MATCHES "\n## ${section}\n\n[^#]")
    message(SEND_ERROR "ERROR: the report lacks the section '${section}', or it is empty.")
  endif ()
endforeach ()
foreach (text IN ITEMS "aorta" "vessels" "projective shear-warp" "encoded and sorted" "\\*\\*(holds|does not hold)")
  if (NOT report MATCHES "${text}")
    message(SEND_ERROR "ERROR: the report has no '${text}'.")
  endif ()
endforeach ()
if (report MATCHES "[^a-z](nan|inf)[^a-z]")
  message(SEND_ERROR "ERROR: a number of the report is none.")
endif ()
foreach (figure IN ITEMS figure-10 figure-11 figure-12 figure-13)
  if (NOT EXISTS "${FOLDER}/${figure}.png" OR NOT report MATCHES "\\(${figure}\\.png\\)")
    message(SEND_ERROR "ERROR: ${figure}.png is missing.")
  endif ()
endforeach ()
