# MPI, optional: target polybody_mpi where it is found (Debian: libopenmpi-dev openmpi-bin). A user's program takes
# find_package(MPI REQUIRED COMPONENTS CXX) and MPI::MPI_CXX.
set(MPI_CXX_SKIP_MPICXX ON) # the C++ bindings of old
find_package(MPI QUIET COMPONENTS CXX)
if(MPI_CXX_FOUND AND MPIEXEC_EXECUTABLE)
  # Its definitions are set for single sources, ${MPI_CXX_COMPILE_DEFINITIONS}: they share precompiled headers with others.
  add_library(polybody_mpi INTERFACE)
  target_include_directories(polybody_mpi SYSTEM INTERFACE ${MPI_CXX_INCLUDE_DIRS})
  target_link_libraries(polybody_mpi INTERFACE ${MPI_CXX_LIBRARIES})
else()
  message(STATUS "MPI is not found: studies use threads only, and the tests of studies over ranks are not built")
endif()
