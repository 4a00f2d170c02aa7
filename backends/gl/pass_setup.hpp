// What all passes use: their render targets and texture units, and the capabilities that are off in them.
#pragma once

#include <photongrid/backends/gl/functions.hpp>

#include <array>

namespace photongrid::gl {

/// The render targets of a pass, and the texture units of inputs and states (textures.glsl, fragment_prelude.glsl).
inline constexpr GLuint max_outputs = 8, max_inputs = 10, state_unit = max_inputs, units = state_unit + max_outputs;

/// Capabilities that are disabled in passes. Blending, which is per draw buffer, and the scissor test, which is per
/// viewport, are disabled separately; a pass uses the first viewport only.
inline constexpr std::array<GLenum, 22> off_in_passes{GL_CULL_FACE, GL_DEPTH_TEST, GL_STENCIL_TEST,
    GL_RASTERIZER_DISCARD, GL_COLOR_LOGIC_OP, GL_DEPTH_CLAMP, GL_POLYGON_OFFSET_FILL, GL_POLYGON_SMOOTH, GL_SAMPLE_MASK,
    GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_ALPHA_TO_ONE, GL_SAMPLE_COVERAGE, GL_SAMPLE_SHADING, GL_DITHER,
    GL_CLIP_DISTANCE0, GL_CLIP_DISTANCE1, GL_CLIP_DISTANCE2, GL_CLIP_DISTANCE3, GL_CLIP_DISTANCE4, GL_CLIP_DISTANCE5,
    GL_CLIP_DISTANCE6, GL_CLIP_DISTANCE7};

} // namespace photongrid::gl
