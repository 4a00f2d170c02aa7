// What stencil routing does with the photons for which a cell has no slot (2.2.2, "surplus photons").
#pragma once

namespace photongrid {

/// What becomes of photons for which a cell of a routed map has no slot. The power of the cell is kept either way.
enum class surplus_kind {
    /// Photons that the cell keeps stand for the others: they are in the map as often as photons arrived, with their
    /// power divided among their entries. Searches count entries, so k photons reach as far as in a sorted map.
    photons,
    /// Photons that the cell keeps take the others' power and count once, as in the paper. Where cells overflow, k
    /// photons then reach farther than in a sorted map, and fine structures such as caustics blur.
    power
};

} // namespace photongrid
