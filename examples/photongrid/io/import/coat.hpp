// Reflectances of plastic in programs that have no light between coat and base.
#pragma once

#include <photongrid/scene/material.hpp>

namespace photongrid {

/// Changes the reflectance of a plastic, and its texture, from the share of the light that passed the coat that leaves
/// it again to that of the surface below the coat, between which and the coat light goes back and forth.
void set_reflectance_below_coat(material& plastic);

/// The reverse.
void set_reflectance_above_coat(material& plastic);

} // namespace photongrid
