# SPDX-License-Identifier: BSD-3-Clause
# TAUTLINE_SANITIZE: everything is compiled with AddressSanitizer and UndefinedBehaviorSanitizer; any finding ends the
# program. (-g1: file and line in its report.) Clang also counts the branches that libFuzzer needs to find new paths.
# TAUTLINE_SEARCH=OFF: nothing is counted, which is compiled faster; the fuzzers are seeded mutators.
option(TAUTLINE_SEARCH "Fuzzers look for inputs that reach new code, where the compiler has libFuzzer" ON)
mark_as_advanced(TAUTLINE_SEARCH)
set(TAUTLINE_LIBFUZZER OFF)
if (NOT TAUTLINE_SANITIZE)
  return ()
endif ()
set(sanitizers -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
add_compile_options(${sanitizers})
add_link_options(-fsanitize=address,undefined)
add_compile_definitions(_GLIBCXX_ASSERTIONS) # checks of indices in containers
if (TAUTLINE_SEARCH AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  include(CheckCXXSourceCompiles)
  set(CMAKE_REQUIRED_FLAGS -fsanitize=fuzzer)
  check_cxx_source_compiles("extern \"C\" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }"
    TAUTLINE_HAS_LIBFUZZER)
  unset(CMAKE_REQUIRED_FLAGS)
  if (TAUTLINE_HAS_LIBFUZZER)
    set(TAUTLINE_LIBFUZZER ON)
    add_compile_options(-fsanitize=fuzzer-no-link)
  endif ()
endif ()
