# cmake -DABIDW=… -DABIDIFF=… -DHEADERS=… -DLIBRARY=… -DDUMP=… -DOUTPUT=… -P: the library's binary interface is the one on
# record. Two dumps are compared, because that of the record knows no headers to tell handles from open types.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/dump_abi.cmake)
execute_process(COMMAND ${ABIDIFF} ${DUMP} ${OUTPUT}
  RESULT_VARIABLE result OUTPUT_VARIABLE report ERROR_VARIABLE report)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${report}
The interface differs from capi/package/brinell.abi.
If something was only added (a function in the map's newest node, a member at the end of a struct), run
'./dev abi-update', read the difference and commit it. If something was removed or changed, existing programs
break: don't, or first raise library_abi in capi/CMakeLists.txt, and say so in CHANGELOG.md.")
endif()
