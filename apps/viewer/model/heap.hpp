#pragma once

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace shape3d::apps::viewer {

/// Gives memory that large work has freed back to the system, which glibc keeps otherwise.
inline void trim_heap() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace shape3d::apps::viewer
