# cmake -DABIDW=… -DHEADERS=… -DLIBRARY=… -DOUTPUT=… -P: writes the binary interface of the library as text: the exported
# functions and the types of brinell.h that they use; handles are opaque.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${ABIDW} --headers-dir ${HEADERS} --drop-private-types --exported-interfaces-only
  --no-corpus-path --no-comp-dir-path --no-show-locs --no-elf-needed --no-parameter-names
  --out-file ${OUTPUT} ${LIBRARY} COMMAND_ERROR_IS_FATAL ANY)
