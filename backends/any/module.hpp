// Modules of a program: shared objects that it loads when it needs them. A backend or a window whose libraries are
// missing or broken then fails alone; linked, it would keep the program from starting.
#pragma once

#include <photongrid/backends/any/backend_entry.hpp>
#include <photongrid/version.hpp>

#include <string>

/// Stands in each module, so that no program loads another version's.
#define PHOTONGRID_MODULE                                                                                              \
    extern "C" long photongrid_module_version() { return photongrid::library_version; }

namespace photongrid::any {

/// Whether the module NAME.so is there; it may still fail to load.
bool has_module(const std::string& name);

/// The address of a function in the module NAME.so. It lies in the folder `photongrid-modules` beside the program where
/// that was built, in PHOTONGRID_MODULES relative to the program where it is installed.
/// \throws backend_error if the module is not there, is another version's, or cannot be loaded; the message names the
///         library that failed.
void* function_of_module(const std::string& name, const std::string& function);

/// The entry of the backend that the module NAME holds.
/// \throws backend_error as function_of_module().
backend_entry entry_of_module(const std::string& name);

} // namespace photongrid::any
