// Light as people see it.
#pragma once

namespace photongrid {

/// Lumens of a watt of light of 555 nm (CIE): glTF's candela, lux and nits are so many times W/sr, W/m^2 and W/(m^2
/// sr).
inline constexpr double luminous_efficacy = 683;

} // namespace photongrid
