// Saves and restores the OpenGL state of a caller's context, so that a call of this backend leaves it unchanged, also
// after an exception. device.hpp (set_state) and routing.hpp change the state; each group of state (saved_state.hpp) is
// saved before it is first changed. The backend's own contexts do not use this.
#pragma once

#include <photongrid/backends/gl/pending_errors.hpp>
#include <photongrid/backends/gl/saved_state.hpp>
#include <photongrid/backends/gl/undisturbed.hpp>

#include <array>
#include <optional>
#include <utility>

namespace photongrid::gl {

/// Keeps a caller's state during a call. Calls may nest; each group of state is saved once and restored at the end of
/// the outermost call.
class callers_state {
public:
    /// `question`: an occlusion query for internal use. `hear`: debug callback during calls; may be null.
    callers_state(functions& call, GLuint question, GLDEBUGPROC hear, const void* user)
        : gl_(call), errors_(call), undisturbed_(call, question), hear_(hear), user_(user)
    {
    }
    callers_state(const callers_state&) = delete;
    callers_state& operator=(const callers_state&) = delete;

    /// Begins a call. Errors that are already pending belong to the caller: they are saved, and restored at the end.
    /// \throws backend_error for a pending error that cannot be restored, such as GL_OUT_OF_MEMORY.
    void enter()
    {
        if (depth_ == 0) {
            errors_.keep();
            if (hear_ != nullptr) {
                debug_.emplace(gl_);
                detail::hear_driver(gl_, hear_, user_);
            }
        }
        ++depth_;
    }
    /// Ends a call. The outermost one restores everything.
    void leave() noexcept
    {
        if (--depth_ > 0)
            return;
        if (stencil_)
            stencil_->restore(gl_);
        if (blending_)
            blending_->restore(gl_);
        restore_units();
        if (pack_)
            pack_->restore(gl_);
        if (unpack_)
            unpack_->restore(gl_);
        if (passes_)
            passes_->restore(gl_);
        stencil_.reset();
        blending_.reset();
        pack_.reset();
        unpack_.reset();
        passes_.reset();
        errors_.give_back();
        if (debug_)
            debug_->restore(gl_);
        debug_.reset();
    }

    /// Saves the state on first use; returns true if it did, and the caller then sets its own.
    /// \throws backend_error for state that a pass would disturb and that cannot be restored.
    bool save_passes()
    {
        if (passes_)
            return false;
        undisturbed_.check();
        return save(passes_);
    }
    bool save_stencil() { return save(stencil_); }
    bool save_blending() { return save(blending_); }
    bool save_unit(GLuint unit)
    {
        if (active_unit_ == 0)
            active_unit_ = detail::get_name(gl_, GL_ACTIVE_TEXTURE);
        if (unit_states_[unit])
            return false;
        gl_.ActiveTexture(GL_TEXTURE0 + unit);
        unit_states_[unit] = detail::unit_state{
            detail::get_name(gl_, GL_TEXTURE_BINDING_2D), detail::get_name(gl_, GL_SAMPLER_BINDING)};
        return true;
    }
    /// Saves the pixel storage modes and sets those for transfers.
    void set_transfer(detail::pixel_state::direction d)
    {
        auto& saved = d == detail::pixel_state::pack ? pack_ : unpack_;
        if (!saved)
            saved.emplace(gl_, d).clear(gl_);
    }

private:
    template <class State>
    bool save(std::optional<State>& saved)
    {
        if (saved)
            return false;
        saved.emplace(gl_);
        return true;
    }
    void restore_units()
    {
        if (active_unit_ == 0)
            return;
        for (GLuint unit = 0; unit < units; ++unit)
            if (const auto saved = std::exchange(unit_states_[unit], {})) {
                gl_.ActiveTexture(GL_TEXTURE0 + unit);
                gl_.BindTexture(GL_TEXTURE_2D, saved->texture); // glBindTextureUnit(unit, 0) would unbind all targets
                gl_.BindSampler(unit, saved->sampler);
            }
        gl_.ActiveTexture(std::exchange(active_unit_, 0));
    }

    functions& gl_;
    int depth_ = 0;
    detail::pending_errors errors_;
    detail::undisturbed undisturbed_;
    std::optional<detail::debug_state> debug_;
    std::optional<detail::pass_state> passes_;
    std::optional<detail::stencil_state> stencil_;
    std::optional<detail::blend_state> blending_;
    std::optional<detail::pixel_state> pack_, unpack_;
    std::array<std::optional<detail::unit_state>, units> unit_states_;
    GLenum active_unit_ = 0; ///< 0: not saved
    GLDEBUGPROC hear_;
    const void* user_;
};

/// The scope of a call of the backend. `state` is null in the backend's own contexts.
class call_scope {
public:
    explicit call_scope(callers_state* state) : state_(state)
    {
        if (state_ != nullptr)
            state_->enter();
    }
    call_scope(const call_scope&) = delete;
    call_scope& operator=(const call_scope&) = delete;
    ~call_scope()
    {
        if (state_ != nullptr)
            state_->leave();
    }

private:
    callers_state* state_;
};

} // namespace photongrid::gl
