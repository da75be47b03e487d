cmake_minimum_required(VERSION 3.18...3.25)
# Writes bus/build_id.h's function: version, git commit, and "dirty" when the
# tree differs from it. Run at build time:
# cmake -DSOURCE=... -DVERSION=... -DOUTPUT=file.cc -P BuildId.cmake
set(id "${VERSION}")
find_program(GIT git)
if(GIT)
  execute_process(COMMAND "${GIT}" -C "${SOURCE}" describe --always --dirty
    --abbrev=12 --exclude=*
    OUTPUT_VARIABLE commit RESULT_VARIABLE failed ERROR_QUIET
    OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT failed)
    string(APPEND id "+${commit}")
  endif()
endif()
file(CONFIGURE OUTPUT "${OUTPUT}" @ONLY CONTENT
"#include \"bus/build_id.h\"

namespace terra::bus {
const char* BuildId() { return \"@id@\"; }
}  // namespace terra::bus
")
