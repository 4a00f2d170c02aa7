// Splicing kernel texts, and bringing compilers' messages home.
#include "kernel_files.hpp"

#include <photongrid/core/kernel_source.hpp>
#include <photongrid/map/bitonic_step.kernel.hpp>
#include <photongrid/map/photon_cell.kernel.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

namespace {

using namespace photongrid;

constexpr text_file library[]
    = {{"kernels/a.glsl", "// a\nint a;\n"}, {"kernels/b.glsl", "#include \"a.glsl\"\nint b;\n"}};
constexpr text_file prelude{"prelude.glsl", "#version 450\nint p;\n"};
constexpr text_file kernel{"kernels/k.glsl", "// k\n#include \"b.glsl\"\n#include \"a.glsl\"\nint k;\n"};
constexpr text_file epilogue{"epilogue.glsl", "void main() {}\n"};

TEST(splice, numbers_every_line_by_its_own_file)
{
    const auto s = splice(prelude, "#define X 1\n", kernel, epilogue, library);
    ASSERT_EQ(s.files,
        (std::vector<std::string>{
            "prelude.glsl", "kernels/k.glsl", "kernels/b.glsl", "kernels/a.glsl", "epilogue.glsl"}));
    // Follow the #line directives as a compiler would and check that each declaration is where its file has it.
    std::istringstream in(s.text);
    std::size_t number = 1, seen = 0;
    bool version_first = false;
    for (std::string row; std::getline(in, row); ++number) {
        if (row.starts_with("#version"))
            version_first = number == 1;
        if (row.starts_with("#line ")) {
            number = std::stoul(row.substr(6)) - 1;
            continue;
        }
        const std::pair<const char*, std::size_t> places[] = {
            {"int p;", 100002}, {"int k;", 200004}, {"int b;", 300002}, {"int a;", 400002}, {"void main() {}", 500001}};
        for (const auto& [text, line] : places)
            if (row == text) {
                EXPECT_EQ(number, line) << text;
                ++seen;
            }
    }
    EXPECT_TRUE(version_first);
    EXPECT_EQ(seen, 5u); // each file once
}

TEST(splice, names_the_place_of_a_missing_file)
{
    const text_file bad{"kernels/bad.glsl", "//\n#include \"nowhere.glsl\"\n"};
    try {
        splice(prelude, "", bad, epilogue, library);
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_STREQ(e.what(), "kernels/bad.glsl:2: error: no kernel file named \"nowhere.glsl\"");
    }
}

/// The texts of a user who has files of the same name as one of the library's.
constexpr text_file same_names[]
    = {{"mine/vector.glsl", "int mine;\n"}, {"../../include/photongrid/core/vector.glsl", "int librarys;\n"},
        {"vector.glsl", "int outer;\n"}, {"mine/deep/vector.glsl", "#include \"../vector.glsl\"\nint deep;\n"},
        {"mine/other.glsl", "#include <photongrid/core/vector.glsl>\n"}};

TEST(splice, finds_the_file_that_cpp_finds)
{
    const auto spliced = [](const char* name, const char* text) {
        std::vector<text_file> library(std::begin(same_names), std::end(same_names));
        const auto forth = splice(prelude, "", {name, text}, epilogue, library);
        std::reverse(library.begin(), library.end());
        const auto back = splice(prelude, "", {name, text}, epilogue, library);
        EXPECT_EQ(forth.text, back.text);
        return std::vector<std::string>(forth.files.begin() + 2, forth.files.end() - 1);
    };
    using names = std::vector<std::string>;
    const names librarys{"../../include/photongrid/core/vector.glsl"};
    EXPECT_EQ(spliced("mine/k.glsl", "#include <photongrid/core/vector.glsl>\n"), librarys);
    EXPECT_EQ(spliced("mine/k.glsl", "#include \"vector.glsl\"\n"), names{"mine/vector.glsl"});
    EXPECT_EQ(spliced("k.glsl", "#include \"vector.glsl\"\n"), names{"vector.glsl"});
    EXPECT_EQ(spliced("k.glsl", "#include \"mine/deep/vector.glsl\"\n"),
        (names{"mine/deep/vector.glsl", "mine/vector.glsl"}));
    EXPECT_EQ(spliced("mine/deep/k.glsl", "#include \"../other.glsl\"\n"), (names{"mine/other.glsl", librarys[0]}));
    // Both, under one basename.
    EXPECT_EQ(spliced("mine/k.glsl", "#include <photongrid/core/vector.glsl>\n#include \"vector.glsl\"\n"),
        (names{librarys[0], "mine/vector.glsl"}));
    // "tor.glsl" is no component of a path.
    EXPECT_THROW(spliced("k.glsl", "#include \"tor.glsl\"\n"), std::runtime_error);
}

TEST(splice, says_which_files_an_include_may_mean)
{
    const text_file elsewhere{"far/k.glsl", "\n#include \"vector.glsl\"\n"};
    try {
        splice(prelude, "", elsewhere, epilogue, std::span(same_names).first(2));
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_STREQ(e.what(),
            "far/k.glsl:2: error: \"vector.glsl\" may be mine/vector.glsl or ../../include/photongrid/core/"
            "vector.glsl");
    }
}

TEST(translate_log, understands_three_drivers)
{
    const auto s = splice(prelude, "", kernel, epilogue, library);
    EXPECT_EQ(translate_log("0:200004(5): error: `x' undeclared\n", s),
        "kernels/k.glsl:4: error: `x' undeclared\n    int k;\n");
    EXPECT_EQ(
        translate_log("0:300002(1): preprocessor error: syntax\n", s), "kernels/b.glsl:2: error: syntax\n    int b;\n");
    EXPECT_EQ(translate_log("ERROR: 0:400002: 'y' : undeclared identifier \n", s),
        "kernels/a.glsl:2: error: 'y' : undeclared identifier \n    int a;\n");
    EXPECT_EQ(translate_log("0(500001) : error C0000: syntax error\n", s),
        "epilogue.glsl:1: error: C0000: syntax error\n    void main() {}\n");
    EXPECT_EQ(translate_log("something else\n", s), "something else\n");
}

TEST(kernel_texts, a_kernel_carries_its_text_and_those_that_it_includes)
{
    const auto texts = texts_of<kernels::photon_cell>({});
    EXPECT_EQ(find_kernel_text(kernels::photon_cell::path, texts).name, "include/photongrid/map/photon_cell.glsl");
    EXPECT_NE(find_kernel_text("grid.glsl", texts).text.find("struct Grid"), std::string_view::npos);
    EXPECT_THROW(find_kernel_text("bitonic_step.glsl", texts), std::runtime_error);
    const auto step = texts_of<kernels::bitonic_step>({});
    EXPECT_NE(
        find_kernel_text(kernels::bitonic_step::path, step).text.find("void kernel(uint i)"), std::string_view::npos);
}

TEST(kernel_texts, folders_tell_files_of_one_name_apart)
{
    const auto name = [](std::string_view path) { return find_kernel_text(path, same_names).name; };
    EXPECT_EQ(name("/home/user/project/vector.glsl"), "vector.glsl");
    EXPECT_EQ(name("/home/user/project/mine/vector.glsl"), "mine/vector.glsl");
    EXPECT_EQ(name("C:\\project\\mine\\deep\\vector.glsl"), "mine/deep/vector.glsl");
    EXPECT_EQ(name("/usr/include/photongrid/core/vector.glsl"), same_names[1].name);
    EXPECT_EQ(name("/opt/headers/photongrid/core/vector.glsl"), same_names[1].name);
    EXPECT_EQ(name("../mine/vector.glsl"), "mine/vector.glsl");
    EXPECT_EQ(name("elsewhere/other.glsl"), "mine/other.glsl"); // its file's name is enough
    EXPECT_THROW(name("mine/another.glsl"), std::runtime_error);
}

// Hard cases G4, G7: what is fused, cut at NaN, or approximated differently from device to device is not in the
// dialect. (min and max are exact; kernels give them no NaN. exact_arithmetic.glsl is used where its fma passes a
// test.)
TEST(kernel_texts, kernels_call_no_function_that_devices_round_differently)
{
    const std::regex comment("//[^\n]*"),
        forbidden(
            R"(\b(fma|pow|a?sin|a?cos|a?tan|exp2?|log2?|clamp|mix|mod|fract|dot|cross|length|distance|normalize|reflect|refract|inversesqrt) *\()");
    const auto files = photongrid::testing::kernel_files();
    EXPECT_GT(files.size(), 50u);
    for (const auto& f : files) {
        if (f.name.ends_with("/core/exact_arithmetic.glsl"))
            continue;
        const auto code = std::regex_replace(f.text, comment, "");
        std::smatch m;
        EXPECT_FALSE(std::regex_search(code, m, forbidden)) << f.name << " calls " << m[1];
    }
}

/// Every file of backends/ without comments, by its path.
std::map<std::string, std::string> backend_sources()
{
    std::map<std::string, std::string> texts;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(PHOTONGRID_BACKENDS)) {
        if (!entry.is_regular_file())
            continue;
        std::ostringstream text;
        text << std::ifstream(entry.path()).rdbuf();
        texts[entry.path().string()] = std::regex_replace(text.str(), std::regex("//[^\n]*"), "");
    }
    return texts;
}

// Hard case G3: sums of floats whose order a device chooses. Atomic operations are on whole numbers, and floats are
// blended in one place, route's sums, where OpenGL keeps the order of the points.
TEST(backend_texts, no_float_is_added_in_an_order_that_a_device_chooses)
{
    std::size_t atomics = 0, blends = 0;
    for (const auto& [path, text] : backend_sources()) {
        EXPECT_FALSE(
            std::regex_search(text, std::regex("shader_atomic_float|imageAtomic|subgroupAdd|subgroupExclusiveAdd")))
            << path;
        const std::regex running(R"(.*\bsubgroupInclusiveAdd\b.*)"),
            of_uint(R"(uint \w+\(uint (\w+)\) \{ return subgroupInclusiveAdd\(\1\); \})");
        for (std::sregex_iterator at(text.begin(), text.end(), running); at != std::sregex_iterator(); ++at)
            EXPECT_TRUE(std::regex_match((*at)[0].str(), of_uint)) << path << ": " << (*at)[0] << ": not of a uint";
        const std::regex atomic(R"(\batomic[A-Z]\w*\((\w+))");
        for (std::sregex_iterator at(text.begin(), text.end(), atomic); at != std::sregex_iterator(); ++at) {
            ++atomics;
            EXPECT_TRUE(std::regex_search(text, std::regex("\\buint " + (*at)[1].str() + "\\b")))
                << path << ": " << (*at)[0] << ": not on a uint";
        }
        const std::regex enabled(R"(Enablei?\(GL_BLEND)");
        const auto here
            = std::distance(std::sregex_iterator(text.begin(), text.end(), enabled), std::sregex_iterator());
        blends += static_cast<std::size_t>(here);
        EXPECT_TRUE(here == 0 || path.ends_with("routing.hpp")) << path;
    }
    EXPECT_GT(atomics, 3u);
    EXPECT_EQ(blends, 1u);
    for (const auto& f : photongrid::testing::kernel_files())
        EXPECT_EQ(f.text.find("atomic"), std::string::npos) << f.name;
}

} // namespace
