// Buffers, limits and messages of the OpenGL backend.
#pragma once

#include "gl_contexts.hpp"
#include "gl_test_kernels.hpp"

namespace photongrid {
namespace {

    // Without this, silence of the driver would prove nothing.
    TYPED_TEST(gl_backend_test, records_the_drivers_messages)
    {
        auto& b = this->gpu();
        const auto before = b.upload(view(noise<glm::uvec2>(4, 1)));
        auto after = b.template make<glm::uvec2>(4);
        EXPECT_EQ(b.take_debug_messages(), "");
        gl::functions call; // those of the context that the backend left current
        call.load(TypeParam::kind == gl_context_kind::osmesa ? gl::find_by_osmesa : gl::find_by_egl);
        call.Enable(0xDEAD);
        const bool mesa = b.caps().software; // it names the function, others may not
        const auto message = b.take_debug_messages();
        EXPECT_NE(message.find(mesa ? "glEnable" : "GL_INVALID_ENUM"), std::string::npos) << message;
        call.Enable(0xDEAD);
        try { // the next pass tells
            b.template run<test_kernels::next_frame>(4, {.stride = 0u}, reads(before), writes(after));
            FAIL();
        } catch (const backend_error& e) {
            EXPECT_NE(std::string_view(e.what()).find("GL_INVALID_ENUM"), std::string_view::npos) << e.what();
            EXPECT_TRUE(!mesa || std::string_view(e.what()).find("glEnable") != std::string_view::npos) << e.what();
        }
        EXPECT_EQ(b.take_debug_messages(), "");
    }

    TYPED_TEST(gl_backend_test, describes_its_device)
    {
        const capabilities& c = this->gpu().caps();
        EXPECT_EQ(c.backend, TypeParam::name);
        EXPECT_FALSE(c.device.empty());
        EXPECT_GE(c.max_elements, 1u << 24);
        EXPECT_EQ(c.max_route_slots, 16u);
        if (c.device.find("llvmpipe") != std::string::npos) {
            EXPECT_TRUE(c.software);
            EXPECT_TRUE(c.exact_division);
            EXPECT_TRUE(c.exact_sqrt);
            EXPECT_EQ(c.loop_limit, 65535u);
        }
    }

    TYPED_TEST(gl_backend_test, buffers_keep_every_bit)
    {
        round_trip<float>(this->gpu());
        round_trip<glm::vec2>(this->gpu());
        round_trip<glm::vec4>(this->gpu());
        round_trip<uint>(this->gpu());
        round_trip<glm::uvec2>(this->gpu());
        round_trip<glm::uvec4>(this->gpu());
    }

    TYPED_TEST(gl_backend_test, counts_its_memory)
    {
        gl_backend& b = this->gpu();
        const auto before = b.bytes();
        {
            auto buffer = b.template make<glm::vec4>(4096);
            EXPECT_EQ(b.bytes(), before + 65536);
            auto moved = std::move(buffer);
            EXPECT_EQ(moved.size(), 4096u);
            EXPECT_EQ(buffer.size(), 0u);
            buffer = std::move(moved);
            EXPECT_EQ(b.bytes(), before + 65536);
        }
        EXPECT_EQ(b.bytes(), before);
        EXPECT_GE(b.peak_bytes(), before + 65536);
    }

    TYPED_TEST(gl_backend_test, names_the_limit_that_a_buffer_exceeds)
    {
        gl_backend& b = this->gpu();
        const auto before = b.bytes();
        try {
            b.template make<uint>(b.caps().max_elements + 1);
            FAIL();
        } catch (const backend_error& e) {
            EXPECT_NE(std::string(e.what()).find(std::to_string(b.caps().max_elements)), std::string::npos) << e.what();
        }
        auto pairs = b.upload(view(noise<glm::uvec2>(1, 1)));
        auto amounts = b.upload(view(noise<glm::vec4>(1, 1)));
        const uint destinations = 1u << 21; // times 256 pixels: more than 16384 x 16384 texels
        if (b.caps().software) {
            auto totals = b.template make<glm::vec4>(destinations);
            buffer_of<gl_backend, uint> slots;
            EXPECT_THROW((b.template route<test_kernels::to_place>(
                             1, {}, reads(pairs, amounts), {destinations, 16u}, slots, totals)),
                std::invalid_argument);
        }
        auto small = b.template make<uint>(10);
        EXPECT_THROW((b.template run<kernels::pair_value>(11, {}, reads(pairs), writes(small))), std::invalid_argument);
        pairs = {};
        amounts = {};
        small = {};
        EXPECT_EQ(b.bytes(), before);
    }

    TYPED_TEST(gl_backend_test, reports_errors_at_the_kernels_own_line)
    {
        const auto message = [&]<class K>(std::type_identity<K>) -> std::string {
            try {
                this->gpu().template compile<K>();
            } catch (const backend_error& e) {
                return e.what();
            }
            return "no error";
        };
        const std::string semantic = message(std::type_identity<test_kernels::broken>{});
        EXPECT_NE(semantic.find("tests/broken.glsl:6: error:"), std::string::npos) << semantic;
        EXPECT_NE(semantic.find("value = i.w;"), std::string::npos) << semantic;
        const std::string syntax = message(std::type_identity<test_kernels::misspelt>{});
        EXPECT_NE(syntax.find("tests/misspelt.glsl:7: error:"), std::string::npos) << syntax;
        const std::string layout = message(std::type_identity<test_kernels::wrongly_laid_out>{});
        EXPECT_NE(layout.find("std140"), std::string::npos) << layout;
        const auto messages = this->gpu().take_debug_messages();
        EXPECT_TRUE(messages != "" || !this->gpu().caps().software) << "Mesa's compiler errors are messages too";
        // And goes on as if nothing had happened.
        EXPECT_EQ(this->gpu().template count<test_kernels::is_odd>(
                      1, {}, reads(this->gpu().upload(view(std::vector<uint>{3u})))),
            1u);
    }

} // namespace
} // namespace photongrid
