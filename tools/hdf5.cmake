# How HDF5 is compiled from source, for cargo (.cargo/config.toml): without the warnings of its developers, and of
# development builds with less optimisation, which takes two thirds of the time. Releases keep all of it.
set(HDF5_DISABLE_COMPILER_WARNINGS ON CACHE BOOL "")
if("$ENV{PROFILE}" STREQUAL "debug" AND NOT CMAKE_HOST_WIN32)
  set(CMAKE_C_FLAGS_RELEASE "-O1 -DNDEBUG" CACHE STRING "")
endif()
