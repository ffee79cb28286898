# SPDX-License-Identifier: BSD-3-Clause
# What records the calls of programs (libse3d-record) and what plays them (`se3d replay`): both are made
# of the public headers by tools/record_calls.py, which needs python3.

# SE3D_HAS_RECORD says whether they can be made. SE3D_RECORD_PLAYER: sources of the player.
function(se3d_find_record_parts)
    set(SE3D_HAS_RECORD OFF PARENT_SCOPE)
    if(NOT SE3D_RECORD)
        return()
    endif()
    find_package(Python3 COMPONENTS Interpreter)
    if(NOT CMAKE_SYSTEM_NAME STREQUAL "Linux" OR NOT Python3_FOUND OR NOT TARGET se3d_io)
        message(STATUS "No recordings of calls: they are made on Linux only, and need python3 for the build")
        return()
    endif()
    set(SE3D_HAS_RECORD ON PARENT_SCOPE)
endfunction()

function(se3d_add_record)
    set(folder "${PROJECT_BINARY_DIR}/record")
    set(record "${PROJECT_SOURCE_DIR}/record")
    file(GLOB headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/include/se3d/*.h")
    set(made "${folder}/layouts.c" "${folder}/recorded.c" "${folder}/played.c")
    add_custom_command(OUTPUT ${made} VERBATIM
        COMMAND Python3::Interpreter "${PROJECT_SOURCE_DIR}/tools/record_calls.py" "${folder}"
        DEPENDS "${PROJECT_SOURCE_DIR}/tools/record_calls.py" "${PROJECT_SOURCE_DIR}/tools/check_abi.py"
                "${PROJECT_SOURCE_DIR}/tools/check_headers.py" ${headers})
    add_custom_target(se3d_record_tables DEPENDS ${made})

    find_package(Threads REQUIRED)
    add_library(se3d_record SHARED "${folder}/layouts.c" "${folder}/recorded.c" "${record}/bytes.c"
                "${record}/layout.c" "${record}/recorder.c")
    set_target_properties(se3d_record PROPERTIES OUTPUT_NAME se3d-record)
    target_link_libraries(se3d_record PRIVATE Threads::Threads ${CMAKE_DL_LIBS})

    add_library(se3d_player STATIC "${folder}/layouts.c" "${folder}/played.c" "${record}/bytes.c"
                "${record}/layout.c" "${record}/map.c" "${record}/player.c" "${record}/player_compare.c"
                "${record}/player_read.c" "${record}/score.c" "${record}/stage.c")
    target_compile_definitions(se3d_player PRIVATE SE3D_STATIC)
    target_include_directories(se3d_player INTERFACE "${record}")
    foreach(target se3d_record se3d_player)
        se3d_compile_options(${target})
        set_target_properties(${target} PROPERTIES C_VISIBILITY_PRESET hidden)
        add_dependencies(${target} se3d_record_tables)
        target_include_directories(${target} PRIVATE "${record}" "${PROJECT_SOURCE_DIR}/include")
    endforeach()
endfunction()
