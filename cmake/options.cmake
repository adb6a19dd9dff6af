# What every target of the project is compiled with; linked as bbsim::options.
add_library(bbsim_options INTERFACE)
add_library(bbsim::options ALIAS bbsim_options)

target_compile_options(bbsim_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                                               -Wno-sign-conversion -Wnon-virtual-dtor)
if(BBSIM_WARNINGS_AS_ERRORS)
  target_compile_options(bbsim_options INTERFACE -Werror)
endif()

# a*b + c must mean the same on every machine: results are compared to the bit.
target_compile_options(bbsim_options INTERFACE -ffp-contract=off)

if(BBSIM_SANITIZE)
  target_compile_options(bbsim_options INTERFACE -fsanitize=address,undefined
                                                 -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(bbsim_options INTERFACE -fsanitize=address,undefined)
elseif(BBSIM_STATIC_RUNTIME)
  target_link_options(bbsim_options INTERFACE -static-libstdc++ -static-libgcc)
endif()
