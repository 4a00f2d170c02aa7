// The OpenGL backend: kernels as fragment programs and buffers as textures, as in the paper, on OpenGL 4.5 core. It
// uses no compute shaders and no storage buffers, and reads nothing back between passes except occlusion queries.
#pragma once

#include <photongrid/backends/gl/hand_over.hpp>
#include <photongrid/backends/gl/make_context.hpp>
#include <photongrid/backends/gl/passes.hpp>
#include <photongrid/backends/gl/routing.hpp>
#include <photongrid/backends/gl/texture.hpp>
#include <photongrid/backends/gl/tiles.hpp>
#include <photongrid/core/self_test.hpp>

namespace photongrid {

/// A backend on an OpenGL context. It and its buffers belong to one thread at a time. Every call makes its context
/// current and leaves it current. With gl_context_kind::current the caller makes it current, and every call preserves
/// the caller's OpenGL state, also after an exception: bindings, capabilities, masks and pending errors. Verbs that
/// draw throw backend_error if they would disturb state that cannot be restored: an active query that counts samples or
/// primitives, active transform feedback, conditional rendering, or a program in use that is marked for deletion
/// (docs/guide/embed_in_opengl.md).
/// \headerfile backends/gl/gl.hpp <photongrid/backends/gl/gl.hpp>
/// \snippet snippets_gl.cpp gl_backend
class gl_backend {
public:
    /// Elements in a texture, with the layout that gl_texture describes.
    /// \headerfile backends/gl/gl.hpp <photongrid/backends/gl/gl.hpp>
    template <element T>
    class buffer {
    public:
        /// \name A buffer's members, the same on every backend
        /// @{

        /// A buffer has size() elements T. It can be moved but not copied. A moved-from or default-constructed buffer
        /// is empty.
        using value_type = T;
        buffer() = default;
        buffer(buffer&& other) noexcept { swap(other); }
        buffer& operator=(buffer&& other) noexcept
        {
            buffer(std::move(other)).swap(*this);
            return *this;
        }
        std::size_t size() const noexcept { return size_; }
        /// @}

    private:
        friend gl_backend;
        void swap(buffer& other) noexcept
        {
            std::swap(texture_, other.texture_);
            std::swap(size_, other.size_);
        }
        gl::texture texture_;
        std::size_t size_ = 0;
    };

private:
    // Defined before its uses, because its return type is deduced.
    /// Whether a buffer belongs to this backend, for check_call.
    auto owns() const
    {
        return [this](const auto& b) { return b.texture_.is_of(*device_); };
    }
    template <element T>
    void check_owner(const char* what, const buffer<T>& b) const
    {
        if (!owns()(b))
            throw std::invalid_argument(std::string("gl_backend: ") + what
                + ": the buffer belongs to another backend; download it there and upload it here");
    }

public:
    /// \throws backend_error that says what was tried, what failed and which package to install;
    /// std::invalid_argument for a tile of 0 or above 2048.
    explicit gl_backend(const gl_options& options = {}) : options_(options)
    {
        if (options.tile < 1 || options.tile > gl::row_width)
            throw std::invalid_argument("gl_options: tile: " + std::to_string(options.tile) + "; it must be from 1 to "
                + std::to_string(gl::row_width));
        device_ = std::make_shared<gl::device>(
            gl::make_context(options.context, options.debug, options.find), options.debug);
        const auto scope = device_->use();
        made_ = std::make_unique<gl::programs>(device_);
        queries_ = std::make_unique<gl::queries>(device_);
        const auto text = [&](GLenum what) {
            const auto* s = reinterpret_cast<const char*>(device_->call.GetString(what));
            return std::string(s != nullptr ? s : "unknown");
        };
        caps_.backend = device_->name();
        const std::string renderer = text(GL_RENDERER);
        caps_.device = renderer + ", OpenGL " + text(GL_VERSION);
        caps_.software = gl::is_software(renderer);
        caps_.max_elements = std::min(std::uint64_t{gl::row_width} * device_->max_size, (std::uint64_t{1} << 31) - 1);
        caps_.max_route_slots = std::min(16u, device_->max_point);
        if (!caps_.software)
            caps_.photon_batch = 1u << 22; // as many as there is memory for
        // llvmpipe ends loops silently after so many iterations of an invocation group (lp_bld_limits.h).
        caps_.loop_limit = renderer.find("llvmpipe") != std::string::npos ? 65535u : 0u;
        std::tie(caps_.exact_division, caps_.exact_sqrt)
            = choose_arithmetic(*this, options.arithmetic, [&](bool rewrite) { made_->rewrite_arithmetic(rewrite); });
        made_->costs.clear();
        device_->peak_bytes = device_->bytes;
    }
    /// The buffers of the moved-from backend then belong to this one.
    gl_backend(gl_backend&&) = default;
    gl_backend& operator=(gl_backend&&) = delete;

    /// Kernel texts of your own, embedded by photongrid_embed(); they must outlive the backend.
    void add_texts(std::span<const text_file> texts) { made_->add_texts(texts); }

    /// \name The verbs of a backend, as backend.hpp describes them: buffers
    /// @{

    /// See the concept photongrid::backend.
    template <element T>
    buffer<T> make(std::size_t n)
    {
        if (n > caps_.max_elements)
            throw backend_error(device_->name() + ": a buffer of " + std::to_string(n)
                + " elements was requested; the limit of this device is " + std::to_string(caps_.max_elements)
                + " (textures of " + std::to_string(gl::row_width) + " x " + std::to_string(device_->max_size) + ")");
        buffer<T> b;
        if (n == 0)
            return b;
        const auto scope = device_->use();
        const uint width = std::min(gl::row_width, std::bit_ceil(static_cast<uint>(n)));
        const auto rows = static_cast<uint>((n + gl::row_width - 1) / gl::row_width);
        b.texture_ = gl::texture::make(*device_, gl::texture_format<T>::internal, width, rows, sizeof(T),
            "a buffer of " + std::to_string(n) + " elements");
        b.size_ = n;
        return b;
    }

    template <element T, std::size_t E>
    buffer<T> upload(std::span<const T, E> data)
    {
        if (data.empty())
            return {};
        const auto scope = device_->use();
        auto b = make<T>(data.size());
        device_->prepare_upload();
        using format = gl::texture_format<T>;
        gl::for_blocks(data.size(), [&](std::size_t first, GLint y, GLsizei width, GLsizei rows) {
            device_->call.TextureSubImage2D(
                b.texture_.id, 0, 0, y, width, rows, format::format, format::type, data.data() + first);
        });
        device_->check_errors("upload");
        return b;
    }

    template <element T>
    std::vector<T> download(const buffer<T>& b)
    {
        check_owner("download: b", b);
        const auto scope = device_->use();
        device_->prepare_download();
        std::vector<T> data(b.size());
        using format = gl::texture_format<T>;
        gl::for_blocks(data.size(), [&](std::size_t first, GLint y, GLsizei width, GLsizei rows) {
            const auto bytes = sizeof(T) * static_cast<std::size_t>(width) * static_cast<std::size_t>(rows);
            device_->call.GetTextureSubImage(b.texture_.id, 0, 0, y, 0, width, rows, 1, format::format, format::type,
                static_cast<GLsizei>(bytes), data.data() + first);
        });
        device_->check_errors("download");
        return data;
    }

    /// @}

    /// The buffer as a texture, which OpenGL calls of the caller may read or write, in the order of calls and without a
    /// copy. The buffer continues to own it. After image stores, call glMemoryBarrier before using the buffer again.
    /// \throws std::invalid_argument for a buffer of another backend.
    /// \snippet snippets_gl.cpp texture_of
    template <element T>
    gl_texture texture_of(const buffer<T>& b) const
    {
        check_owner("texture_of: b", b);
        return {b.texture_.id, b.texture_.width, b.texture_.height, b.size_ > 0 ? gl::texture_format<T>::internal : 0u};
    }

    /// A buffer over a caller's texture with the layout of gl_texture. The caller continues to own the texture, which
    /// must outlive the buffer; bytes() does not count it. Texels of level 0 beyond the n elements may be overwritten.
    /// The texture's filters do not matter. For n = 0 the texture is ignored.
    /// \throws std::invalid_argument for a texture of another kind, format or size.
    /// \snippet snippets_gl.cpp adopt
    template <element T>
    buffer<T> adopt(GLuint texture, std::size_t n)
    {
        buffer<T> b;
        if (n == 0)
            return b;
        if (n > caps_.max_elements)
            throw std::invalid_argument("gl_backend::adopt: n: " + std::to_string(n)
                + " elements; the limit of this device is " + std::to_string(caps_.max_elements));
        const auto scope = device_->use();
        const gl_texture t = gl::check_adoptable(
            device_->call, texture, n, gl::texture_format<T>::internal, gl::texture_format<T>::internal_name);
        b.texture_ = gl::texture::adopt(*device_, t.name, t.width, t.height);
        b.size_ = n;
        return b;
    }

    /// Releases the buffer's texture to the caller, who must delete it. bytes() no longer counts it.
    /// \throws std::invalid_argument for a buffer of another backend.
    /// \snippet snippets_gl.cpp release
    template <element T>
    gl_texture release(buffer<T>&& b)
    {
        check_owner("release: b", b);
        const auto scope = device_->use();
        const gl_texture t = texture_of(b);
        b.texture_.let_go();
        b = {};
        return t;
    }

    /// \name The verbs of a backend, as backend.hpp describes them: passes
    /// @{

    /// See the concept photongrid::backend.
    template <gather_kernel K, class Reads, class Writes>
    void run(launch l, const typename K::Params& args, Reads reads, Writes writes)
    {
        detail::check_call<K>("run", l, reads, writes, owns());
        const auto scope = device_->use();
        const GLuint program = made_->get<K>(gl::verb::run, l.switches);
        count_passes<K>(1);
        if (l.elements == 0)
            return;
        start_clock();
        const auto from = names(reads);
        const auto to = names(writes);
        gl::bind<K>(*device_, args, from, to);
        if (gl::set_targets<K>(*device_, from, to))
            device_->call.TextureBarrier();
        gl::draw(*device_, program, l);
        finish_verb<K>("run");
    }

    /// Uses tiles with occlusion queries (3.3): by conditional rendering, the device draws a tile only if the pass
    /// before had an unfinished element in it. The host reads the queries once per 8 passes.
    template <iterative_kernel K, class Reads, class Writes>
    progress run_until_done(launch l, const typename K::Params& args, Reads reads, Writes writes, uint max_passes)
    {
        detail::check_call<K>("run_until_done", l, reads, writes, owns());
        const auto scope = device_->use();
        const GLuint program = made_->get<K>(gl::verb::until_done, l.switches);
        progress p;
        if (l.elements == 0) {
            p.finished = true;
            return p;
        }
        start_clock();
        const auto from = names(reads);
        const auto to = names(writes);
        gl::bind<K>(*device_, args, from, to);
        gl::set_targets<K>(*device_, from, to);
        gl::tiled_passes tiles(*device_, *queries_, l, options_.tile);
        gl::set_launch(*device_, program, l);
        while (!p.finished && p.passes < max_passes) {
            const uint begin = p.passes;
            const uint end = begin + std::min(gl::tiled_passes::together, max_passes - begin);
            tiles.draw(begin, end);
            p.passes = end;
            // These were the last passes: count the elements that are still unfinished.
            const GLuint rest = end == max_passes ? tiles.rest(end - 1) : 0;
            if (rest != 0)
                ask_not_done<K>(l, rest);
            ++query_polls_;
            tiles.read(begin, end, p.active);
            if (rest != 0)
                p.finished = queries_->result(rest) == 0;
            while (!p.active.empty() && p.active.back() == 0) {
                p.active.pop_back();
                p.finished = true;
            }
        }
        if (max_passes == 0) {
            const GLuint rest = tiles.rest(0);
            ask_not_done<K>(l, rest);
            ++query_polls_;
            p.finished = queries_->result(rest) == 0;
        }
        p.passes = static_cast<uint>(p.active.size());
        count_passes<K>(p.passes);
        finish_verb<K>("run_until_done");
        return p;
    }

    template <predicate_kernel K, class Reads>
    std::uint64_t count(launch l, const typename K::Params& args, Reads reads)
    {
        detail::check_call<K>("count", l, reads, std::tuple<>{}, owns());
        const auto scope = device_->use();
        const GLuint program = made_->get<K>(gl::verb::holds, l.switches);
        count_passes<K>(1);
        if (l.elements == 0)
            return 0;
        check_end("count: elements", l);
        queries_->make(1);
        start_clock();
        gl::bind<K>(*device_, args, names(reads), std::array<GLuint, 0>{});
        gl::draw_counted(*device_, program, l, (*queries_)[0]);
        ++query_polls_;
        const std::uint64_t n = queries_->result((*queries_)[0]);
        finish_verb<K>("count");
        return n;
    }

    template <route_kernel K, class Reads>
    void route(launch l, const typename K::Params& args, Reads reads, const route_shape& to, buffer<uint>& slots,
        buffer<glm::vec4>& totals)
    {
        detail::check_route(to, caps_.max_route_slots, slots.size(), totals.size());
        const auto [destinations, m] = to;
        detail::check_reads<K>("route", reads, owns());
        check_owner("route: slots", slots);
        check_owner("route: totals", totals);
        check_end("route: draws", l);
        const auto scope = device_->use();
        gl::routing pass{*device_, *made_, made_->get<K>(gl::verb::route_payload, l.switches),
            made_->get<K>(gl::verb::route_amount, l.switches), l, destinations, m};
        count_passes<K>(1);
        start_clock();
        gl::bind<K>(*device_, args, names(reads), std::array<GLuint, 0>{});
        if (totals.size() > 0)
            pass.sum(totals.texture_, route_sums(totals.size(), destinations));
        if (slots.size() > 0)
            pass.fill(slots.texture_, slots.size());
        finish_verb<K>("route");
    }

    /// @}

    /// Compiles kernel K for every verb that can use it, without running it.
    /// \throws backend_error with the compiler's log.
    template <kernel_struct K>
    void compile(uint switches = ~0u)
    {
        const auto scope = device_->use();
        if constexpr (gather_kernel<K>)
            made_->get<K>(gl::verb::run, switches);
        if constexpr (iterative_kernel<K>) {
            made_->get<K>(gl::verb::until_done, switches);
            made_->get<K>(gl::verb::not_done, switches);
        }
        if constexpr (predicate_kernel<K>)
            made_->get<K>(gl::verb::holds, switches);
        if constexpr (route_kernel<K>) {
            made_->get<K>(gl::verb::route_payload, switches);
            made_->get<K>(gl::verb::route_amount, switches);
        }
    }

    /// \name The verbs of a backend, as backend.hpp describes them: properties and costs
    /// @{

    /// See the concept photongrid::backend.
    void finish()
    {
        const auto scope = device_->use();
        device_->call.Finish();
        device_->check_errors("finish");
    }
    const capabilities& caps() const { return caps_; }
    std::uint64_t bytes() const { return device_->bytes; }
    std::uint64_t peak_bytes() const { return device_->peak_bytes; }
    const std::map<std::string, kernel_cost>& costs() const { return made_->costs; }
    /// @}

    /// The number of readbacks and mappings. Only `download` reads back.
    std::uint64_t readbacks() const { return device_->call.readbacks(); }

    /// The driver's messages of high severity since the last call, one per line, that no exception has reported,
    /// including its compiler's. Always empty without options.debug.
    std::string take_debug_messages() { return std::exchange(device_->messages, {}); }
    /// The number of times that the host waited for occlusion queries.
    std::uint64_t query_polls() const { return query_polls_; }

private:
    /// Checks the last element of a launch that writes no buffer, whose size would limit it.
    void check_end(const char* what, const launch& l) const
    {
        if (std::uint64_t{l.first} + l.elements > caps_.max_elements)
            throw backend_error(device_->name() + ": " + what + " up to "
                + std::to_string(std::uint64_t{l.first} + l.elements) + "; the limit of this device is "
                + std::to_string(caps_.max_elements));
    }

    /// The textures of the buffers of a call.
    template <class... Buffers>
    static std::array<GLuint, sizeof...(Buffers)> names(const std::tuple<Buffers...>& buffers)
    {
        return std::apply(
            [](const auto&... b) { return std::array<GLuint, sizeof...(Buffers)>{b.texture_.id...}; }, buffers);
    }

    /// Counts the unfinished elements in `query`. States stay bound.
    template <class K>
    void ask_not_done(const launch& l, GLuint query)
    {
        gl::draw_counted(*device_, made_->get<K>(gl::verb::not_done, l.switches), l, query);
    }

    template <class K>
    void count_passes(uint passes)
    {
        made_->costs[std::string(kernel_name<K>())].passes += passes;
    }
    void start_clock()
    {
        if (options_.time_passes)
            queries_->start_clock();
    }
    template <class K>
    void finish_verb(const char* verb)
    {
        if (options_.time_passes)
            made_->costs[std::string(kernel_name<K>())].ms += queries_->stop_clock();
        if (options_.debug || device_->is_callers()) // so that our errors do not remain for the caller
            device_->check_errors(std::string(verb) + "<" + std::string(kernel_name<K>()) + ">");
    }

    gl_options options_;
    std::shared_ptr<gl::device> device_;
    std::unique_ptr<gl::programs> made_;
    std::unique_ptr<gl::queries> queries_;
    capabilities caps_;
    std::uint64_t query_polls_ = 0;
};

static_assert(backend<gl_backend>);

} // namespace photongrid

// Declared with the backend, so that all files of a program use the same overrides.
#include <photongrid/backends/gl/overrides/bitonic_sort.hpp>
