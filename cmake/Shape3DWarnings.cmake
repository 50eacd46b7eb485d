# Warnings of our own sources: PRIVATE, so that users of the libraries do not inherit them.
function(shape3d_set_warnings target)
  set(gnu_like $<CXX_COMPILER_ID:GNU,Clang,AppleClang>)
  target_compile_options(${target} PRIVATE
    $<${gnu_like}:-Wall;-Wextra;-Wpedantic;-Wshadow;-Wconversion;-Wno-sign-conversion>
    $<${gnu_like}:-Wold-style-cast;-Wnon-virtual-dtor;-Woverloaded-virtual;-Wundef>)
  if(SHAPE3D_WARNINGS_AS_ERRORS)
    set_property(TARGET ${target} PROPERTY COMPILE_WARNING_AS_ERROR ON)
  endif()
endfunction()
