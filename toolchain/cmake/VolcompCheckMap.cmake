# cmake -DMAP=FILE -P VolcompCheckMap.cmake: fails if the linker's map of an image names a member of volcomp_metrology, which
# is for the evaluation of measurements and for hosts. Members that --gc-sections empties are named, too.
file(STRINGS "${MAP}" members REGEX "libvolcomp_metrology\\.a\\(")
if(members)
  list(GET members 0 first)
  message(FATAL_ERROR "the image links volcomp_metrology: ${first}")
endif()
file(SIZE "${MAP}" size)
if(size EQUAL 0)
  message(FATAL_ERROR "${MAP} is empty: nothing is proven")
endif()
