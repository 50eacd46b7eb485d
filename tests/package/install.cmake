# Installs the build to ${work}/prefix. The folder is renamed after that: an installed package that
# holds a path of its build or of its first place does not work any more.
file(REMOVE_RECURSE ${work}/prefix ${work}/first-prefix)
execute_process(
  COMMAND ${CMAKE_COMMAND} --install ${build} --config ${config} --prefix ${work}/first-prefix
  COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${work}/first-prefix ${work}/prefix)
