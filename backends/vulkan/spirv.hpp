// Compiles GLSL to SPIR-V by glslang and the SPIRV-Tools optimizer, with NoContraction on all float arithmetic.
#pragma once

#include <photongrid/core/backend.hpp>
#include <photongrid/core/kernel_source.hpp>

#include <cstdint>
#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
#include <memory>
#include <span>
#include <spirv-tools/optimizer.hpp>
#include <string>
#include <unordered_set>
#include <vector>

namespace photongrid::vulkan {

using spirv_words = std::vector<std::uint32_t>;

/// Calls f(opcode, offset, length) for each instruction of a module, in order.
template <class F>
void for_each_instruction(std::span<const std::uint32_t> words, F f)
{
    for (std::size_t at = 5; at < words.size();) {
        const std::size_t length = std::max(words[at] >> 16u, 1u);
        f(words[at] & 0xFFFFu, at, length);
        at += length;
    }
}

/// The number of instructions in a module's functions, without names, types and decorations.
inline std::uint64_t count_instructions(std::span<const std::uint32_t> words)
{
    std::uint64_t n = 0;
    bool inside = false;
    for_each_instruction(words, [&](std::uint32_t op, std::size_t, std::size_t) {
        constexpr std::uint32_t function = 54, function_end = 56;
        inside = inside || op == function;
        n += inside ? 1u : 0u;
        inside = inside && op != function_end;
    });
    return n;
}

/// Decorates every float arithmetic instruction with NoContraction, so that neither drivers nor the optimizer contract
/// a*b+c, reassociate, or replace a division by a multiplication. Results then equal the serial backend's bit for bit.
inline spirv_words forbid_contraction(const spirv_words& in)
{
    constexpr std::uint32_t decorate = 71, member_decorate = 72, no_contraction = 42;
    std::unordered_set<std::uint32_t> decorated;
    std::size_t decorations_end = 0;
    for_each_instruction(in, [&](std::uint32_t op, std::size_t at, std::size_t length) {
        if (op == decorate || op == member_decorate)
            decorations_end = at + length;
        if (op == decorate && length > 2 && in[at + 2] == no_contraction)
            decorated.insert(in[at + 1]);
    });
    spirv_words extra;
    for_each_instruction(in, [&](std::uint32_t op, std::size_t at, std::size_t) {
        // OpFNegate, OpFAdd, OpFSub, OpFMul, OpFDiv, OpFRem, OpFMod, and OpVectorTimesScalar to OpDot.
        const bool arithmetic = op == 127 || op == 129 || op == 131 || op == 133 || op == 136 || op == 140 || op == 141
            || (op >= 142 && op <= 148);
        if (arithmetic && decorated.insert(in[at + 2]).second)
            extra.insert(extra.end(), {(3u << 16u) | decorate, in[at + 2], no_contraction});
    });
    if (extra.empty() || decorations_end == 0)
        return in;
    spirv_words out(in.begin(), in.begin() + static_cast<std::ptrdiff_t>(decorations_end));
    out.insert(out.end(), extra.begin(), extra.end());
    out.insert(out.end(), in.begin() + static_cast<std::ptrdiff_t>(decorations_end), in.end());
    return out;
}

/// Compiles a compute shader to SPIR-V for Vulkan 1.1. `name` is for messages.
/// \throws backend_error with file and line in the kernel's own source.
inline spirv_words compile_spirv(const spliced_source& source, const std::string& name, bool optimized)
{
    // glslang counts its users. This reference stays until the program ends.
    static const struct process {
        process() { glslang_initialize_process(); }
        ~process() { glslang_finalize_process(); }
    } once;

    glslang_input_t input{};
    input.language = GLSLANG_SOURCE_GLSL;
    input.stage = GLSLANG_STAGE_COMPUTE;
    input.client = GLSLANG_CLIENT_VULKAN;
    input.client_version = GLSLANG_TARGET_VULKAN_1_1;
    input.target_language = GLSLANG_TARGET_SPV;
    input.target_language_version = GLSLANG_TARGET_SPV_1_3;
    input.code = source.text.c_str();
    input.default_version = 450;
    input.default_profile = GLSLANG_NO_PROFILE;
    input.messages = static_cast<glslang_messages_t>(GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT);
    input.resource = glslang_default_resource();
    const std::unique_ptr<glslang_shader_t, void (*)(glslang_shader_t*)> shader(
        glslang_shader_create(&input), glslang_shader_delete);
    if (!shader || !glslang_shader_preprocess(shader.get(), &input) || !glslang_shader_parse(shader.get(), &input))
        throw backend_error("vulkan: kernel '" + name + "' does not compile:\n"
            + translate_log(shader ? glslang_shader_get_info_log(shader.get()) : "no memory", source));
    const std::unique_ptr<glslang_program_t, void (*)(glslang_program_t*)> program(
        glslang_program_create(), glslang_program_delete);
    glslang_program_add_shader(program.get(), shader.get());
    if (!glslang_program_link(program.get(), input.messages))
        throw backend_error("vulkan: kernel '" + name + "' does not link:\n"
            + translate_log(glslang_program_get_info_log(program.get()), source));
    glslang_spv_options_t options{};
    options.disable_optimizer = true;
    glslang_program_SPIRV_generate_with_options(program.get(), GLSLANG_STAGE_COMPUTE, &options);
    const std::uint32_t* made = glslang_program_SPIRV_get_ptr(program.get());
    const spirv_words plain(made, made + glslang_program_SPIRV_get_size(program.get()));

    // Before optimization, so that the optimizer does not fold constants through float arithmetic, and after it, for
    // new instructions.
    auto decorated = forbid_contraction(plain);
    if (!optimized)
        return decorated; // the instrumentation breaks loops of one block, which the optimizer creates
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_1);
    std::string complaints;
    optimizer.SetMessageConsumer([&](spv_message_level_t level, const char*, const spv_position_t&, const char* text) {
        if (level <= SPV_MSG_ERROR)
            complaints += std::string(text) + "\n";
    });
    optimizer.RegisterPerformancePasses();
    spvtools::OptimizerOptions how;
    how.set_run_validator(false);
    spirv_words better;
    if (!optimizer.Run(decorated.data(), decorated.size(), &better, how))
        throw backend_error("vulkan: kernel '" + name + "': the SPIR-V optimizer failed:\n" + complaints);
    return forbid_contraction(better);
}

} // namespace photongrid::vulkan
