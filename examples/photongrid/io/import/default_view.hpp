// What a scene gets whose file has no camera, or no light.
#pragma once

#include <photongrid/scene/scene.hpp>

namespace photongrid {

/// A sky that shows shapes: bright at the horizon, blue above, dim below, and with a soft bright patch, to the left of
/// default_camera() and above, as a photographer's lamp.
environment_map default_sky();

/// A camera, and whether it is within the scene.
struct chosen_camera {
    camera view;
    bool is_inside = false;
};

/// A camera that sees the whole scene from in front, above and a little to the right; a flat scene from further above
/// or before it. What stands on a ground of its own mesh fills the picture, not the ground. Where no light of the
/// scene's lamps gets out, as in a closed room, the camera is in one of its corners.
chosen_camera default_camera(const scene& s);

} // namespace photongrid
