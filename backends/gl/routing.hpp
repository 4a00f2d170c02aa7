// Stencil routing as in the paper (2.2.2, figure 5): every draw is a point of m x m pixels over its destination, of
// which the stencil test passes one pixel, the destination's next free slot.
#pragma once

#include <photongrid/backends/gl/program.hpp>
#include <photongrid/backends/gl/texture.hpp>

#include <cmath>

namespace photongrid::gl {

/// A routing pass. `payload` and `amount` are the two programs of a route kernel, whose inputs and Params are bound.
/// costs() counts the draw of payloads as the kernel's pass, and the other draws under the names of their shaders;
/// the time of all is the kernel's.
struct routing {
    device& on;
    programs& made;
    GLuint payload, amount;
    launch draws;
    uint destinations, m;

    /// Computes slots[d * capacity + r] = payload of the r-th draw to d, for `n` slots; empty slots are `no_id`. It
    /// changes texture unit 0.
    /// \throws backend_error if the footprints exceed the device's largest render target.
    void fill(const texture& slots, std::size_t n)
    {
        functions& gl = on.call;
        const uint capacity = route_capacity(m);
        // About square, because both edges are limited.
        const uint columns = std::max(1u, static_cast<uint>(std::ceil(std::sqrt(static_cast<double>(destinations)))));
        const uint rows = std::max(1u, (destinations + columns - 1) / columns);
        const std::string what = "route: " + std::to_string(destinations) + " destinations of " + std::to_string(m)
            + " x " + std::to_string(m) + " slots";
        const texture drawn = texture::make(on, GL_R32UI, columns * m, rows * m, 4, what);
        texture stencil;
        const GLuint framebuffer = make_framebuffer(drawn, stencil, what);
        try {
            gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
            on.keep_stencil();
            on.set_viewport(0, 0, static_cast<GLsizei>(drawn.width), static_cast<GLsizei>(drawn.height));
            gl.StencilMask(0xFFu);
            constexpr GLint zero = 0;
            constexpr std::array<GLuint, 4> empty{no_id, 0, 0, 0};
            gl.ClearNamedFramebufferuiv(framebuffer, GL_COLOR, 0, empty.data());
            gl.ClearNamedFramebufferiv(framebuffer, GL_STENCIL, 0, &zero);
            gl.Enable(GL_STENCIL_TEST);
            draw_pattern(capacity);
            draw_points(capacity, columns, rows);
        } catch (...) {
            gl.DeleteFramebuffers(1, &framebuffer);
            throw;
        }
        gl.Disable(GL_STENCIL_TEST);

        on.draw_into(std::array{slots.id});
        const GLuint gather = made.own("route_gather.glsl");
        gl.UseProgram(gather);
        gl.ProgramUniform4ui(gather, 0, columns, destinations, m, capacity);
        on.bind_texture(0, drawn.id);
        on.set_viewport(0, 0, static_cast<GLsizei>(slots.width), static_cast<GLsizei>((n + row_width - 1) / row_width));
        gl.DrawArrays(GL_TRIANGLES, 0, 3);
        ++made.costs["route_gather"].passes;
        gl.DeleteFramebuffers(1, &framebuffer);
    }

    /// Computes totals[d * sums + p] = sum of the amounts of the draws to d in the p-th block of draws, in draw order,
    /// by blending.
    void sum(const texture& totals, uint sums)
    {
        functions& gl = on.call;
        constexpr std::array<GLfloat, 4> zero{};
        on.draw_into(std::array{totals.id});
        on.set_viewport(0, 0, static_cast<GLsizei>(totals.width), static_cast<GLsizei>(totals.height));
        on.clear_targets(zero);
        if (draws.elements == 0)
            return;
        gl.UseProgram(amount);
        gl.ProgramUniform4ui(amount, 1, totals.width, destinations, 1, totals.height);
        gl.ProgramUniform4ui(amount, 2, sums, route_block(draws.elements, sums), draws.first, 0);
        on.keep_blending();
        gl.Enablei(GL_BLEND, 0);
        gl.BlendEquationi(0, GL_FUNC_ADD);
        gl.BlendFunci(0, GL_ONE, GL_ONE);
        gl.DrawArrays(GL_POINTS, static_cast<GLint>(draws.first), static_cast<GLsizei>(draws.elements));
        ++made.costs["route_amount"].passes;
        gl.Disablei(GL_BLEND, 0);
    }

private:
    GLuint make_framebuffer(const texture& drawn, texture& stencil, const std::string& what)
    {
        functions& gl = on.call;
        GLuint framebuffer = 0;
        gl.CreateFramebuffers(1, &framebuffer);
        gl.NamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, drawn.id, 0);
        struct choice {
            GLenum format, attachment;
            std::size_t bytes;
        };
        // A stencil format without depth is optional in OpenGL; one with depth is not.
        for (const auto& c : {choice{GL_STENCIL_INDEX8, GL_STENCIL_ATTACHMENT, 1},
                 choice{GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL_ATTACHMENT, 4}}) {
            stencil = texture::make(on, c.format, drawn.width, drawn.height, c.bytes, what + ", stencil");
            gl.NamedFramebufferTexture(framebuffer, c.attachment, stencil.id, 0);
            if (gl.CheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
                return framebuffer;
            gl.NamedFramebufferTexture(framebuffer, c.attachment, 0, 0);
        }
        gl.DeleteFramebuffers(1, &framebuffer);
        throw backend_error(
            on.name() + ": " + what + ": the driver supports no 8-bit stencil together with an R32UI target");
    }

    void draw_pattern(uint capacity)
    {
        functions& gl = on.call;
        const GLuint pattern = made.own("route_pattern.glsl");
        gl.UseProgram(pattern);
        gl.ColorMaski(0, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        gl.StencilFunc(GL_ALWAYS, 0xFF, 0xFFu);
        gl.StencilOp(GL_REPLACE, GL_REPLACE, GL_REPLACE);
        const uint largest = m * m > capacity ? 255u : capacity - 1;
        for (uint bit = 0; bit < static_cast<uint>(std::bit_width(largest)); ++bit) {
            gl.StencilMask(1u << bit);
            gl.ProgramUniform4ui(pattern, 0, m, capacity, bit, 0);
            gl.DrawArrays(GL_TRIANGLES, 0, 3);
            ++made.costs["route_pattern"].passes;
        }
        gl.StencilMask(0xFFu);
        gl.ColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    }

    void draw_points(uint capacity, uint columns, uint rows)
    {
        if (draws.elements == 0)
            return;
        functions& gl = on.call;
        gl.UseProgram(payload);
        gl.ProgramUniform4ui(payload, 1, columns, destinations, m, rows);
        gl.ProgramUniform4ui(payload, 2, 1, draws.elements, draws.first, 0);
        // GL_INCR saturates at 255, above every reference value, so a full destination stays full
        // (docs/design/decisions.md).
        gl.StencilFunc(GL_EQUAL, static_cast<GLint>(capacity - 1), 0xFFu);
        gl.StencilOp(GL_INCR, GL_INCR, GL_INCR);
        gl.DrawArrays(GL_POINTS, static_cast<GLint>(draws.first), static_cast<GLsizei>(draws.elements));
    }
};

} // namespace photongrid::gl
