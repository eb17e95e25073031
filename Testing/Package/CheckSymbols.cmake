# Fails if a library exports a name without the project's prefix or namespace.
execute_process(COMMAND "${NM}" -D --defined-only -C "${LIBRARY}"
  OUTPUT_VARIABLE symbols
  COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" symbols "${symbols}")
list(LENGTH symbols count)
if (count LESS 20)
  message(FATAL_ERROR "${LIBRARY} exports ${count} names only.")
endif ()
# An address, a letter for the kind, perhaps a type that is returned or what is told of a class.
list(FILTER symbols EXCLUDE REGEX
  "^[0-9a-f]+ [A-Za-z] ([a-z ]+ )?(splatting::|vtk[A-Za-z]*SplattingMIP)")
if (symbols)
  list(JOIN symbols "\n" symbols)
  message(FATAL_ERROR "${LIBRARY} exports names of others:\n${symbols}")
endif ()
