// Kernels as OpenGL programs. Each is compiled once per verb and set of switches.
#pragma once

#include <photongrid/backend_texts/gl.hpp>
#include <photongrid/backends/gl/device.hpp>
#include <photongrid/core/kernel_source.hpp>

#include <chrono>

namespace photongrid::gl {

/// The verb of a kernel's program.
enum class verb { run, until_done, not_done, holds, route_payload, route_amount };

/// Compiles a shader.
/// \throws backend_error with the compiler's log, in which each message has its own file and line.
inline GLuint compile(device& d, GLenum stage, const spliced_source& source, const std::string& what)
{
    functions& gl = d.call;
    const GLuint shader = gl.CreateShader(stage);
    const char* text = source.text.c_str();
    gl.ShaderSource(shader, 1, &text, nullptr);
    gl.CompileShader(shader);
    GLint good = 0, length = 0;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good)
        return shader;
    gl.GetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    gl.GetShaderInfoLog(shader, length, nullptr, log.data());
    log.resize(std::min(log.find('\0'), log.size()));
    gl.DeleteShader(shader);
    throw backend_error(d.name() + ": " + what + ": the OpenGL compiler failed:\n" + translate_log(log, source));
}

/// Links a program of two shaders and deletes them.
/// \throws backend_error with the linker's log.
inline GLuint link(device& d, GLuint vertex, GLuint fragment, const std::string& what)
{
    functions& gl = d.call;
    const GLuint program = gl.CreateProgram();
    gl.AttachShader(program, vertex);
    gl.AttachShader(program, fragment);
    gl.LinkProgram(program);
    gl.DeleteShader(vertex);
    gl.DeleteShader(fragment);
    GLint good = 0, length = 0;
    gl.GetProgramiv(program, GL_LINK_STATUS, &good);
    if (good)
        return program;
    gl.GetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    gl.GetProgramInfoLog(program, length, nullptr, log.data());
    log.resize(std::min(log.find('\0'), log.size()));
    gl.DeleteProgram(program);
    throw backend_error(d.name() + ": " + what + ": the OpenGL linker failed:\n" + log);
}

/// The programs of a backend, which are compiled when they are first needed.
class programs {
public:
    explicit programs(std::shared_ptr<device> d) : device_(std::move(d)) { add_texts(gl_texts); }
    programs(const programs&) = delete;
    programs& operator=(const programs&) = delete;
    ~programs()
    {
        try {
            device_->make_current();
        } catch (const backend_error&) {
            return;
        }
        forget_kernels();
        for (const auto& [key, id] : own_)
            device_->call.DeleteProgram(id);
    }

    /// More kernel texts, in addition to the library's. They must outlive the backend.
    void add_texts(std::span<const text_file> texts) { library_.insert(library_.end(), texts.begin(), texts.end()); }

    /// Kernels that are compiled from now on take quotients and square roots from exact_arithmetic.glsl, or do not.
    void rewrite_arithmetic(bool rewrite)
    {
        forget_kernels();
        exact_arithmetic_ = rewrite ? &text("exact_arithmetic.glsl") : nullptr;
    }

    /// The program of kernel K for verb `v` with these switches.
    template <kernel_struct K>
    GLuint get(verb v, uint switches)
    {
        switches &= known_switches<K>();
        const auto key = std::tuple(K::path.data(), v, switches);
        if (const auto found = kernels_.find(key); found != kernels_.end())
            return found->second;
        const auto start = std::chrono::steady_clock::now();
        const std::string name(kernel_name<K>());
        const std::string what = "kernel " + name;
        const auto texts = texts_of<K>(library_);
        const text_file& kernel = find_kernel_text(K::path, texts);
        std::string defines = "#define SWITCHES_ " + std::to_string(switches) + "u\n";
        GLuint program = 0;
        if (v == verb::route_payload || v == verb::route_amount) {
            const GLuint vertex = gl::compile(*device_, GL_VERTEX_SHADER,
                splice(text("vertex_prelude.glsl"), defines, kernel, text("vertex_epilogue.glsl"), texts,
                    exact_arithmetic_),
                what + " (vertex stage)");
            program = link(*device_, vertex,
                compile_own(GL_FRAGMENT_SHADER, v == verb::route_payload ? "route_payload.glsl" : "route_amount.glsl"),
                what);
        } else {
            constexpr std::array verbs{"RUN_", "UNTIL_DONE_", "NOT_DONE_", "HOLDS_"};
            defines += std::string("#define ") + verbs[static_cast<std::size_t>(v)] + "\n#define STATE_UNIT_ "
                + std::to_string(state_unit) + "\n#define LOAD_STATES_(at) " + load_states<K>() + "\n";
            const GLuint fragment = gl::compile(*device_, GL_FRAGMENT_SHADER,
                splice(text("fragment_prelude.glsl"), defines, kernel, text("fragment_epilogue.glsl"), texts,
                    exact_arithmetic_),
                what + " (fragment stage)");
            program = link(*device_, compile_own(GL_VERTEX_SHADER, "screen.glsl"), fragment, what);
        }
        kernels_.emplace(key, program);
        check_layout(program, sizeof(typename K::Params), what);
        costs[name].compile_ms
            += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        return program;
    }

    /// A program of the backend itself, with the fragment shader `file`.
    GLuint own(const char* file)
    {
        GLuint& program = own_[file];
        if (program == 0)
            program = link(
                *device_, compile_own(GL_VERTEX_SHADER, "screen.glsl"), compile_own(GL_FRAGMENT_SHADER, file), file);
        return program;
    }

    std::map<std::string, kernel_cost> costs;

private:
    static const text_file& text(std::string_view name) { return find_kernel_text(name, gl_texts); }
    void forget_kernels()
    {
        for (const auto& [key, id] : kernels_)
            device_->call.DeleteProgram(id);
        kernels_.clear();
    }
    GLuint compile_own(GLenum stage, const char* file)
    {
        photongrid::detail::splicer s(library_);
        s.append(text(file));
        return gl::compile(*device_, stage, s.take(), file);
    }
    template <class K>
    static std::string load_states()
    {
        std::string calls;
        if constexpr (output_count<K> != 0)
            photongrid::detail::for_each_slot<output_count<K>>([&](auto s) {
                if (K::is_state(s))
                    calls += "load_state_" + std::to_string(s.index) + "(at); ";
            });
        return calls;
    }
    /// Params are passed as bytes, so the driver's layout must be that of C++.
    void check_layout(GLuint program, std::size_t size, const std::string& what)
    {
        const GLuint block = device_->call.GetUniformBlockIndex(program, "args_block_");
        if (block == GL_INVALID_INDEX)
            return;
        GLint bytes = 0;
        device_->call.GetActiveUniformBlockiv(program, block, GL_UNIFORM_BLOCK_DATA_SIZE, &bytes);
        if (static_cast<std::size_t>(bytes) != (size + 15) / 16 * 16)
            throw backend_error(device_->name() + ": " + what + ": its Params have " + std::to_string(size)
                + " bytes in C++ and " + std::to_string(bytes)
                + " in std140; put members of 16 bytes first and use no vec3 (docs/design/design.md)");
    }

    std::shared_ptr<device> device_;
    const text_file* exact_arithmetic_ = nullptr; ///< where kernels are rewritten
    std::vector<text_file> library_;
    std::map<std::tuple<const char*, verb, uint>, GLuint> kernels_;
    std::map<std::string, GLuint> own_;
};

} // namespace photongrid::gl
