# Spectra, optional and headers only: target polybody_spectra where it is found (Debian: libspectra-dev).
find_path(POLYBODY_SPECTRA_INCLUDE Spectra/SymGEigsShiftSolver.h)
mark_as_advanced(POLYBODY_SPECTRA_INCLUDE)
if(POLYBODY_SPECTRA_INCLUDE)
  add_library(polybody_spectra INTERFACE)
  target_include_directories(polybody_spectra SYSTEM INTERFACE ${POLYBODY_SPECTRA_INCLUDE})
else()
  message(STATUS "Spectra is not found: its tests are not built")
endif()
