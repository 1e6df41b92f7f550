# Files of a Linux desktop and of Debian's rules: menu entry, icon, MIME types, manual page, licence and changelog.
set(linux_dir ${CMAKE_CURRENT_LIST_DIR})
install(FILES ${linux_dir}/terrella.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT program)
install(FILES ${linux_dir}/terrella.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT program)
install(FILES ${linux_dir}/terrella.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT program)

# The manual page is the program's own help, by help2man.
find_program(HELP2MAN help2man)
if(HELP2MAN)
  set(manual ${PROJECT_BINARY_DIR}/terrella.1)
  add_custom_command(OUTPUT ${manual}.gz
    COMMAND ${HELP2MAN} --no-info --name "look at planets, and cut, stream and store tiles of their pictures"
      --include=${linux_dir}/terrella.h2m --output=${manual} $<TARGET_FILE:terrella_program>
    COMMAND gzip -9nf ${manual}
    DEPENDS terrella_program ${linux_dir}/terrella.h2m VERBATIM)
  add_custom_target(terrella_manual ALL DEPENDS ${manual}.gz)
  install(FILES ${manual}.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
endif()

set(documents ${PROJECT_BINARY_DIR}/documents)
string(TIMESTAMP changelog_date "%a, %d %b %Y 00:00:00 +0000" UTC)
configure_file(${linux_dir}/changelog.in ${documents}/changelog @ONLY)
file(ARCHIVE_CREATE OUTPUT ${documents}/changelog.gz PATHS ${documents}/changelog FORMAT raw COMPRESSION GZip MTIME 0)
file(ARCHIVE_CREATE OUTPUT ${documents}/CHANGES.md.gz PATHS ${PROJECT_SOURCE_DIR}/CHANGELOG.md FORMAT raw
  COMPRESSION GZip MTIME 0)
set(package_of_program terrella)
set(package_of_development libterrella-dev)
set(package_of_python python3-terrella)
set(components program development)
if(TARGET terrella_python)
  list(APPEND components python)
endif()
foreach(component IN LISTS components)
  install(FILES ${linux_dir}/copyright ${documents}/changelog.gz COMPONENT ${component}
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package_of_${component}})
endforeach()
install(FILES ${documents}/CHANGES.md.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/terrella COMPONENT program)
