// Errors for unsuitable state of the caller, and textures exchanged with the caller.
#pragma once

#include "gl_caller.hpp"
#include "gl_caller_state_tests.hpp"

namespace photongrid::testing {
namespace {

    /// Pairs to be sorted, unless the caller's state forbids passes.
    class unsorted_pairs {
    public:
        explicit unsorted_pairs(gl_backend& b) : b_(b), buffer_(b.upload(view(data_))) {}

        void expect_error(const char* name)
        {
            EXPECT_NE(said(b_, buffer_).find(name), std::string::npos) << name << ", but: " << said(b_, buffer_);
            EXPECT_TRUE(same_bits(b_.download(buffer_), data_)) << name; // uploads and downloads go on
        }
        void expect_sorting()
        {
            EXPECT_EQ(said(b_, buffer_), "");
            EXPECT_TRUE(same_bits(b_.download(buffer_), sorted(data_)));
        }

    private:
        gl_backend& b_;
        const std::vector<glm::uvec2> data_ = random_pairs(100);
        buffer_of<gl_backend, glm::uvec2> buffer_;
    };

    TYPED_TEST(gl_callers_context, no_pass_runs_during_queries_and_conditional_rendering)
    {
        const test_gl& gl = *this->call;
        std::unique_ptr<gl_backend> b = this->make_backend();
        unsorted_pairs pairs(*b);
        for (const auto& [target, name] :
            {std::pair{GL_SAMPLES_PASSED, "GL_SAMPLES_PASSED "}, {GL_ANY_SAMPLES_PASSED, "GL_ANY_SAMPLES_PASSED "},
                {GL_ANY_SAMPLES_PASSED_CONSERVATIVE, "GL_ANY_SAMPLES_PASSED_CONSERVATIVE "},
                {GL_PRIMITIVES_GENERATED, "GL_PRIMITIVES_GENERATED "}}) {
            GLuint query = 0;
            gl.CreateQueries(GLenum(target), 1, &query);
            gl.BeginQuery(GLenum(target), query);
            pairs.expect_error(name);
            gl.EndQuery(GLenum(target));
            if (target == GL_SAMPLES_PASSED) {
                gl.BeginConditionalRender(query, GL_QUERY_WAIT);
                pairs.expect_error("conditional rendering");
                EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR));
                gl.EndConditionalRender();
                EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR)) << "it was still in force";
            }
        }
        pairs.expect_sorting();
    }

    TYPED_TEST(gl_callers_context, no_pass_runs_during_transform_feedback)
    {
        const test_gl& gl = *this->call;
        std::unique_ptr<gl_backend> b = this->make_backend();
        unsorted_pairs pairs(*b), others(*b);
        const GLuint program = gl.CreateProgram();
        const GLuint shader = gl.CreateShader(GL_VERTEX_SHADER);
        gl.ShaderSource(shader, 1, &any_vertex, nullptr);
        gl.CompileShader(shader);
        gl.AttachShader(program, shader);
        const char* recorded = "gl_Position";
        gl.TransformFeedbackVaryings(program, 1, &recorded, GL_INTERLEAVED_ATTRIBS);
        gl.LinkProgram(program);
        gl.UseProgram(program);
        GLuint buffer = 0;
        gl.CreateBuffers(1, &buffer);
        gl.NamedBufferData(buffer, 4096, nullptr, GL_STATIC_DRAW);
        gl.BindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer, 0, 4096);
        gl.BeginTransformFeedback(GL_TRIANGLES);
        pairs.expect_error("transform feedback");
        gl.PauseTransformFeedback();
        others.expect_sorting(); // while it pauses, nothing is recorded
        gl.ResumeTransformFeedback();
        gl.EndTransformFeedback();
        EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR)) << "it could not go on";
        pairs.expect_sorting();
    }

    TYPED_TEST(gl_callers_context, no_pass_runs_if_the_callers_program_could_not_be_restored)
    {
        const test_gl& gl = *this->call;
        std::unique_ptr<gl_backend> b = this->make_backend();
        unsorted_pairs pairs(*b);
        GLuint program = make_program(gl, any_vertex, fragment_of_two);
        gl.UseProgram(program);
        gl.DeleteProgram(program);
        pairs.expect_error("marked for deletion");
        GLint marked = 0;
        gl.GetProgramiv(program, GL_DELETE_STATUS, &marked);
        EXPECT_TRUE(marked) << "it was deleted under the caller's hands";
        program = make_program(gl, any_vertex, fragment_of_two);
        gl.UseProgram(program);
        const char* no_varying = "no such";
        gl.TransformFeedbackVaryings(program, 1, &no_varying, GL_INTERLEAVED_ATTRIBS);
        gl.LinkProgram(program);
        pairs.expect_error("failed to link again");
        gl.UseProgram(0);
        pairs.expect_sorting();
    }

    GLuint make_texture(const test_gl& gl, GLenum target, GLenum format, GLsizei width, GLsizei height)
    {
        GLuint texture = 0;
        gl.CreateTextures(target, 1, &texture);
        gl.TextureStorage2D(texture, 1, format, width, height);
        return texture;
    }

    TYPED_TEST(gl_callers_context, sorts_in_the_callers_texture)
    {
        const test_gl& gl = *this->call;
        std::unique_ptr<gl_backend> b = this->make_backend();
        const auto readbacks = b->readbacks();
        for (const std::size_t n : {std::size_t{3}, std::size_t{2048}, std::size_t{5000}})
            for (const bool is_mutable : {false, true}) {
                const auto data = random_pairs(n);
                const std::size_t rows = (n + 2047) / 2048 + 1; // one to spare
                std::vector<glm::uvec2> texels(rows * 2048, glm::uvec2(7));
                std::copy(data.begin(), data.end(), texels.begin());
                GLuint mine = 0;
                if (is_mutable) { // with filters as OpenGL begins, which want a pyramid of levels that is not there
                    gl.CreateTextures(GL_TEXTURE_2D, 1, &mine);
                    gl.BindTexture(GL_TEXTURE_2D, mine);
                    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RG32UI, 2048, GLsizei(rows), 0, GL_RG_INTEGER, GL_UNSIGNED_INT,
                        texels.data());
                } else {
                    mine = make_texture(gl, GL_TEXTURE_2D, GL_RG32UI, 2048, GLsizei(rows));
                    gl.TextureSubImage2D(
                        mine, 0, 0, 0, 2048, GLsizei(rows), GL_RG_INTEGER, GL_UNSIGNED_INT, texels.data());
                }
                const auto bytes = b->bytes();
                {
                    auto pairs = b->adopt<glm::uvec2>(mine, n);
                    EXPECT_EQ(pairs.size(), n);
                    EXPECT_EQ(b->bytes(), bytes) << "what is the caller's is not counted";
                    bitonic_sort(*b, pairs);
                }
                EXPECT_EQ(b->bytes(), bytes);
                ASSERT_TRUE(gl.IsTexture(mine)) << "the library deleted the caller's texture";
                gl.GetTextureImage(mine, 0, GL_RG_INTEGER, GL_UNSIGNED_INT, GLsizei(texels.size() * sizeof(glm::uvec2)),
                    texels.data());
                texels.resize(n);
                EXPECT_TRUE(same_bits(texels, sorted(data))) << n << (is_mutable ? ", mutable" : "");
                gl.DeleteTextures(1, &mine);
            }
        EXPECT_EQ(b->readbacks(), readbacks);
        EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR));
    }

    // The caller's shader reads the element that texture_of's layout says.
    TYPED_TEST(gl_callers_context, shows_its_buffers_to_the_callers_shaders)
    {
        const test_gl& gl = *this->call;
        std::unique_ptr<gl_backend> b = this->make_backend();
        gl_state objects(gl);
        const GLuint program = make_program(gl, any_vertex,
            "#version 450\nlayout(binding = 3) uniform usampler2D values;\nlayout(location = 0) uniform int "
            "element;\nout vec4 colour;\n"
            "void main() { colour = vec4(texelFetch(values, ivec2(element % 2048, element / 2048), 0).xy / 255.0, 0, "
            "1); }\n");
        const auto data = [] {
            std::vector<glm::uvec2> v(5000);
            for (uint i = 0; i < v.size(); ++i)
                v[i] = {i % 251, i / 251};
            return v;
        }();
        const auto readbacks = b->readbacks();
        const auto values = b->upload(view(data));
        const gl_texture t = b->texture_of(values);
        EXPECT_EQ(t.width, 2048u);
        EXPECT_EQ(t.height, 3u);
        EXPECT_EQ(t.internal_format, GLenum(GL_RG32UI));
        const gl_texture few = b->texture_of(b->make<float>(5));
        EXPECT_EQ(few.width, 8u);
        EXPECT_EQ(few.height, 1u);
        EXPECT_EQ(few.internal_format, GLenum(GL_R32F));
        EXPECT_EQ(b->texture_of(b->make<float>(0)).name, 0u);
        GLuint vertices = 0;
        gl.CreateVertexArrays(1, &vertices);
        gl.BindVertexArray(vertices);
        gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, objects.draw_target);
        gl.BindFramebuffer(GL_READ_FRAMEBUFFER, objects.draw_target);
        gl.Viewport(0, 0, 8, 8);
        gl.UseProgram(program);
        gl.ActiveTexture(GL_TEXTURE0 + 3);
        gl.BindTexture(GL_TEXTURE_2D, t.name);
        for (const int element : {0, 1, 2047, 2048, 4999}) {
            gl.ProgramUniform1i(program, 0, element);
            gl.DrawArrays(GL_TRIANGLES, 0, 3);
            std::array<std::uint8_t, 4> pixel{};
            gl.ReadPixels(3, 3, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
            EXPECT_EQ(pixel[0], element % 251) << element;
            EXPECT_EQ(pixel[1], element / 251) << element;
        }
        EXPECT_EQ(b->readbacks(), readbacks);
        EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR));
    }

    TYPED_TEST(gl_callers_context, throws_for_textures_that_are_no_buffers)
    {
        const test_gl& gl = *this->call;
        std::unique_ptr<gl_backend> b = this->make_backend();
        const auto expect_refusal = [&](GLuint texture, std::size_t n, const char* text) {
            try {
                b->adopt<glm::vec2>(texture, n);
                ADD_FAILURE() << "adopted, instead of: " << text;
            } catch (const std::invalid_argument& e) {
                const std::string said = e.what();
                EXPECT_NE(said.find("gl_backend::adopt: "), std::string::npos) << said;
                EXPECT_NE(said.find(text), std::string::npos) << said;
            }
            EXPECT_EQ(gl.GetError(), GLenum(GL_NO_ERROR)) << text;
        };
        expect_refusal(0, 5, "texture: 0 is not a texture");
        expect_refusal(123456, 5, "is not a texture");
        expect_refusal(make_texture(gl, GL_TEXTURE_1D_ARRAY, GL_RG32F, 8, 1), 5, "GL_TEXTURE_2D");
        expect_refusal(make_texture(gl, GL_TEXTURE_2D, GL_RG16F, 8, 1), 5, "GL_RG32F");
        expect_refusal(make_texture(gl, GL_TEXTURE_2D, GL_RG32UI, 8, 1), 5, "GL_RG32F");
        expect_refusal(make_texture(gl, GL_TEXTURE_2D, GL_RG32F, 4, 1), 5, "a width of 5 at least");
        expect_refusal(
            make_texture(gl, GL_TEXTURE_2D, GL_RG32F, 1024, 4), 4096, "a width of 2048 and a height of 2 at least");
        expect_refusal(make_texture(gl, GL_TEXTURE_2D, GL_RG32F, 4096, 4), 4096, "a width of 2048");
        expect_refusal(make_texture(gl, GL_TEXTURE_2D, GL_RG32F, 2048, 2), 4097, "a height of 3 at least");
        expect_refusal(1, std::size_t{1} << 40, "n: 1099511627776 elements");
        GLuint odd = 0;
        gl.CreateTextures(GL_TEXTURE_2D, 1, &odd);
        gl.TextureStorage2D(odd, 2, GL_RG32F, 8, 8);
        EXPECT_EQ(b->adopt<glm::vec2>(odd, 5).size(), 5u);
        gl.TextureParameteri(odd, GL_TEXTURE_BASE_LEVEL, 1);
        expect_refusal(odd, 5, "GL_TEXTURE_BASE_LEVEL 1");
        gl.TextureParameteri(odd, GL_TEXTURE_BASE_LEVEL, 0);
        for (const int channel :
            {GL_TEXTURE_SWIZZLE_R, GL_TEXTURE_SWIZZLE_G, GL_TEXTURE_SWIZZLE_B, GL_TEXTURE_SWIZZLE_A}) {
            GLuint swizzled = make_texture(gl, GL_TEXTURE_2D, GL_RG32F, 8, 1);
            gl.TextureParameteri(swizzled, GLenum(channel), GL_ZERO);
            expect_refusal(swizzled, 5, "GL_TEXTURE_SWIZZLE");
        }
    }

    TYPED_TEST(gl_callers_context, a_released_texture_outlives_the_backend)
    {
        const test_gl& gl = *this->call;
        std::unique_ptr<gl_backend> b = this->make_backend();
        const auto bytes = b->bytes();
        const auto data = random_pairs(5000);
        auto pairs = b->upload(view(data));
        bitonic_sort(*b, pairs);
        const GLuint deleted = b->texture_of(b->make<uint>(5)).name;
        EXPECT_FALSE(gl.IsTexture(deleted)) << "what is not released is deleted";
        const gl_texture given = b->release(std::move(pairs));
        EXPECT_EQ(pairs.size(), 0u); // NOLINT(bugprone-use-after-move): empty is what release leaves
        EXPECT_EQ(b->bytes(), bytes);
        EXPECT_GT(b->peak_bytes(), bytes);
        b.reset();
        ASSERT_TRUE(gl.IsTexture(given.name));
        std::vector<glm::uvec2> texels(std::size_t{given.width} * given.height);
        gl.GetTextureImage(
            given.name, 0, GL_RG_INTEGER, GL_UNSIGNED_INT, GLsizei(texels.size() * sizeof(glm::uvec2)), texels.data());
        texels.resize(5000);
        EXPECT_TRUE(same_bits(texels, sorted(data)));
    }

} // namespace
} // namespace photongrid::testing
