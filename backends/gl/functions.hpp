// The OpenGL 4.5 core functions that this backend calls, in a table that is filled at run time, because no loader
// library supports contexts of EGL, OSMesa and the caller alike. All calls go through this table, so every readback of
// pixels or buffers is counted (`functions::readbacks`).
#pragma once

#include <photongrid/core/backend.hpp>

#include <GL/glcorearb.h>

#include <cstdint>
#include <string>

namespace photongrid::gl {

/// Finds an OpenGL function by name: eglGetProcAddress, OSMesaGetProcAddress, glfwGetProcAddress, ...
using loader = void (*(*)(const char* name))();

/// A function whose calls are counted.
template <class Function>
struct counted {
    Function function = nullptr;
    std::uint64_t calls = 0;
    template <class... Args>
    auto operator()(Args... args)
    {
        ++calls;
        return function(args...);
    }
};

// clang-format off
// NOLINTBEGIN: a list is written once and read three times
#define PHOTONGRID_GL_CALLS(X)                                                                                         \
    X(GETSTRING, GetString) X(GETINTEGERV, GetIntegerv) X(GETFLOATV, GetFloatv) X(GETERROR, GetError)                  \
    X(GETBOOLEANI_V, GetBooleani_v) X(GETFLOATI_V, GetFloati_v) X(GETINTEGERI_V, GetIntegeri_v)                        \
    X(GETINTEGER64I_V, GetInteger64i_v) X(GETPOINTERV, GetPointerv) X(ISENABLED, IsEnabled)                            \
    X(ISENABLEDI, IsEnabledi) X(ENABLE, Enable) X(DISABLE, Disable) X(ENABLEI, Enablei) X(DISABLEI, Disablei)          \
    X(VIEWPORTINDEXEDF, ViewportIndexedf) X(SCISSORINDEXED, ScissorIndexed) X(COLORMASKI, ColorMaski)                  \
    X(BLENDFUNCI, BlendFunci) X(BLENDFUNCSEPARATEI, BlendFuncSeparatei) X(BLENDEQUATIONI, BlendEquationi)              \
    X(BLENDEQUATIONSEPARATEI, BlendEquationSeparatei) X(POLYGONMODE, PolygonMode) X(CLIPCONTROL, ClipControl)          \
    X(STENCILFUNC, StencilFunc) X(STENCILOP, StencilOp) X(STENCILMASK, StencilMask)                                    \
    X(STENCILFUNCSEPARATE, StencilFuncSeparate) X(STENCILOPSEPARATE, StencilOpSeparate)                                \
    X(STENCILMASKSEPARATE, StencilMaskSeparate) X(PIXELSTOREI, PixelStorei) X(FLUSH, Flush) X(FINISH, Finish)          \
    X(TEXTUREBARRIER, TextureBarrier) X(DRAWARRAYS, DrawArrays) X(GENVERTEXARRAYS, GenVertexArrays)                    \
    X(DELETEVERTEXARRAYS, DeleteVertexArrays) X(BINDVERTEXARRAY, BindVertexArray) X(CREATETEXTURES, CreateTextures)    \
    X(DELETETEXTURES, DeleteTextures) X(TEXTURESTORAGE2D, TextureStorage2D) X(TEXTURESUBIMAGE2D, TextureSubImage2D)    \
    X(TEXTUREPARAMETERI, TextureParameteri) X(ISTEXTURE, IsTexture) X(GETTEXTUREPARAMETERIV, GetTextureParameteriv)    \
    X(GETTEXTURELEVELPARAMETERIV, GetTextureLevelParameteriv) X(ACTIVETEXTURE, ActiveTexture)                          \
    X(BINDTEXTURE, BindTexture) X(BINDTEXTUREUNIT, BindTextureUnit) X(CREATESAMPLERS, CreateSamplers)                  \
    X(DELETESAMPLERS, DeleteSamplers) X(SAMPLERPARAMETERI, SamplerParameteri) X(BINDSAMPLER, BindSampler)              \
    X(CREATEFRAMEBUFFERS, CreateFramebuffers) X(DELETEFRAMEBUFFERS, DeleteFramebuffers)                                \
    X(BINDFRAMEBUFFER, BindFramebuffer) X(NAMEDFRAMEBUFFERTEXTURE, NamedFramebufferTexture)                            \
    X(NAMEDFRAMEBUFFERDRAWBUFFERS, NamedFramebufferDrawBuffers)                                                        \
    X(NAMEDFRAMEBUFFERPARAMETERI, NamedFramebufferParameteri)                                                          \
    X(CHECKNAMEDFRAMEBUFFERSTATUS, CheckNamedFramebufferStatus)                                                        \
    X(CLEARNAMEDFRAMEBUFFERUIV, ClearNamedFramebufferuiv) X(CLEARNAMEDFRAMEBUFFERIV, ClearNamedFramebufferiv)          \
    X(CLEARNAMEDFRAMEBUFFERFV, ClearNamedFramebufferfv) X(CREATEBUFFERS, CreateBuffers)                                \
    X(DELETEBUFFERS, DeleteBuffers) X(NAMEDBUFFERDATA, NamedBufferData) X(BINDBUFFER, BindBuffer)                      \
    X(BINDBUFFERBASE, BindBufferBase) X(BINDBUFFERRANGE, BindBufferRange) X(CREATEQUERIES, CreateQueries)              \
    X(DELETEQUERIES, DeleteQueries) X(BEGINQUERY, BeginQuery) X(ENDQUERY, EndQuery) X(GETQUERYIV, GetQueryiv)          \
    X(QUERYCOUNTER, QueryCounter) X(GETQUERYOBJECTUI64V, GetQueryObjectui64v)                                          \
    X(BEGINCONDITIONALRENDER, BeginConditionalRender) X(ENDCONDITIONALRENDER, EndConditionalRender)                    \
    X(CREATESHADER, CreateShader) X(DELETESHADER, DeleteShader) X(SHADERSOURCE, ShaderSource)                          \
    X(COMPILESHADER, CompileShader) X(GETSHADERIV, GetShaderiv) X(GETSHADERINFOLOG, GetShaderInfoLog)                  \
    X(CREATEPROGRAM, CreateProgram) X(DELETEPROGRAM, DeleteProgram) X(ATTACHSHADER, AttachShader)                      \
    X(LINKPROGRAM, LinkProgram) X(GETPROGRAMIV, GetProgramiv) X(GETPROGRAMINFOLOG, GetProgramInfoLog)                  \
    X(USEPROGRAM, UseProgram) X(PROGRAMUNIFORM4UI, ProgramUniform4ui) X(GETUNIFORMBLOCKINDEX, GetUniformBlockIndex)    \
    X(GETACTIVEUNIFORMBLOCKIV, GetActiveUniformBlockiv) X(GETPROGRAMPIPELINEIV, GetProgramPipelineiv)                  \
    X(GETPROGRAMINTERFACEIV, GetProgramInterfaceiv) X(GETPROGRAMSTAGEIV, GetProgramStageiv)                            \
    X(GETUNIFORMSUBROUTINEUIV, GetUniformSubroutineuiv)                                                                \
    X(UNIFORMSUBROUTINESUIV, UniformSubroutinesuiv) X(DEBUGMESSAGECALLBACK, DebugMessageCallback)

#define PHOTONGRID_GL_READS(X)                                                                                         \
    X(READPIXELS, ReadPixels) X(GETTEXIMAGE, GetTexImage) X(GETTEXTUREIMAGE, GetTextureImage)                          \
    X(GETTEXTURESUBIMAGE, GetTextureSubImage) X(GETBUFFERSUBDATA, GetBufferSubData)                                    \
    X(GETNAMEDBUFFERSUBDATA, GetNamedBufferSubData) X(MAPBUFFER, MapBuffer) X(MAPBUFFERRANGE, MapBufferRange)          \
    X(MAPNAMEDBUFFER, MapNamedBuffer) X(MAPNAMEDBUFFERRANGE, MapNamedBufferRange)

/// The functions, by their names without "gl". Valid for the context (or driver) for which they were loaded.
struct functions {
#define PHOTONGRID_GL_ONE(TYPE, NAME) PFNGL##TYPE##PROC NAME = nullptr;
    PHOTONGRID_GL_CALLS(PHOTONGRID_GL_ONE)
#undef PHOTONGRID_GL_ONE
#define PHOTONGRID_GL_ONE(TYPE, NAME) counted<PFNGL##TYPE##PROC> NAME;
    PHOTONGRID_GL_READS(PHOTONGRID_GL_ONE)
#undef PHOTONGRID_GL_ONE

    /// Loads the functions.
    /// \throws backend_error that names the missing functions.
    void load(loader find)
    {
        std::string missing;
        const auto get = [&](const char* name) {
            auto* f = find(name);
            if (f == nullptr)
                missing += std::string(missing.empty() ? "" : ", ") + name;
            return f;
        };
#define PHOTONGRID_GL_ONE(TYPE, NAME) NAME = reinterpret_cast<PFNGL##TYPE##PROC>(get("gl" #NAME));
        PHOTONGRID_GL_CALLS(PHOTONGRID_GL_ONE)
#undef PHOTONGRID_GL_ONE
#define PHOTONGRID_GL_ONE(TYPE, NAME) NAME.function = reinterpret_cast<PFNGL##TYPE##PROC>(get("gl" #NAME));
        PHOTONGRID_GL_READS(PHOTONGRID_GL_ONE)
#undef PHOTONGRID_GL_ONE
        if (!missing.empty())
            throw backend_error("gl: the driver has no " + missing + "; OpenGL 4.5 core is needed");
    }

    /// The number of readbacks and mappings of pixels and buffers so far.
    std::uint64_t readbacks() const
    {
        std::uint64_t n = 0;
#define PHOTONGRID_GL_ONE(TYPE, NAME) n += NAME.calls;
        PHOTONGRID_GL_READS(PHOTONGRID_GL_ONE)
#undef PHOTONGRID_GL_ONE
        return n;
    }
};
#undef PHOTONGRID_GL_CALLS
#undef PHOTONGRID_GL_READS
// NOLINTEND
// clang-format on

} // namespace photongrid::gl
