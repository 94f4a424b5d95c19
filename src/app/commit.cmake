# Writes OUTPUT, a C++ file that knows the git commit of SOURCE_DIR, and touches it only where that has changed.
execute_process(COMMAND git -C ${SOURCE_DIR} rev-parse --short=12 HEAD
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
if(failed OR NOT commit)
  set(commit unknown)
endif()
set(text "// Made by the build.
namespace lodestone::app {
extern const char* const git_commit;
const char* const git_commit = \"${commit}\";
}  // namespace lodestone::app
")
set(before "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} before)
endif()
if(NOT text STREQUAL before)
  file(WRITE ${OUTPUT} "${text}")
endif()
