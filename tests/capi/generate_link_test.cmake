# cmake -DHEADER=… -DOUTPUT=… -P: writes a C program that refers to every function of the header, so that a
# declaration without a definition does not link.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/declared.cmake)
declared(${HEADER} names)
list(LENGTH names count)
set(rows "")
foreach(name ${names})
  string(APPEND rows "    {\"${name}\", (function)${name}},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"brinell.h\"
#include <stdio.h>

typedef void (*function)(void);

static const struct {
  const char *name;
  function address;
} table[] = {
${rows}};

int main(void) {
  int missing = 0;
  size_t k;
  for (k = 0; k < sizeof table / sizeof *table; ++k) {
    if (table[k].address == NULL) {
      printf(\"%s has no address\\n\", table[k].name);
      ++missing;
    }
  }
  printf(\"%d of %d declared functions are linked\\n\", ${count} - missing, ${count});
  return missing != 0;
}
")
