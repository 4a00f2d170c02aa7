// What every program of snippets checks by.
#pragma once

#include <stdexcept>
#include <string>

/// Ends the program where a snippet does not do what the manual says.
inline void expect(bool right, const std::string& snippet)
{
    if (!right)
        throw std::runtime_error("snippet " + snippet + ": another result than the manual's");
}
