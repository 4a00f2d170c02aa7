#include <photongrid/io/import/spectra.hpp>
#include <photongrid/io/obj/mtl.hpp>
#include <photongrid/io/obj/statement_reader.hpp>

#include <cstddef>
#include <utility>

namespace photongrid::obj {

namespace {
    constexpr double most = 1e15; // as the emission of lights
    constexpr auto expected_number = "a number up to 10^15";

    struct colour_key {
        std::string_view key;
        std::optional<dvec3> mtl_material::*to;
    };
    constexpr colour_key colour_keys[]
        = {{"kd", &mtl_material::kd}, {"ks", &mtl_material::ks}, {"ke", &mtl_material::ke}, {"tf", &mtl_material::tf}};

    struct number_key {
        std::string_view key;
        std::optional<double> mtl_material::*to;
    };
    constexpr number_key number_keys[] = {{"ns", &mtl_material::ns}, {"ni", &mtl_material::ni}, {"d", &mtl_material::d},
        {"tr", &mtl_material::tr}, {"pr", &mtl_material::pr}, {"pm", &mtl_material::pm}};

    struct map_key {
        std::string_view key;
        std::optional<mtl_map> mtl_material::*to;
    };
    constexpr map_key map_keys[] = {{"map_kd", &mtl_material::map_kd}, {"map_ke", &mtl_material::map_ke},
        {"map_d", &mtl_material::map_d}, {"map_pr", &mtl_material::map_pr}, {"map_pm", &mtl_material::map_pm}};

    /// Ambient light is none, and filters of pictures are not asked for.
    constexpr std::string_view ignored_keys[] = {"ka", "map_ka", "map_aat"};
    /// Numbers that change nothing where they are 0.
    constexpr std::string_view coat_keys[] = {"ps", "pc", "aniso"};
    /// Of what those have.
    constexpr std::string_view ignored_numbers[] = {"pcr", "anisor", "sharpness"};

    /// Options of pictures: how many numbers they have at least and at most, and what is said if they are used.
    struct map_option {
        std::string_view name;
        int least, most;
        const char* note;
    };
    constexpr map_option number_options[] = {{"-s", 1, 3, nullptr}, {"-o", 1, 3, nullptr},
        {"-t", 1, 3, "the turbulence of a picture is left out"}, {"-bm", 1, 1, nullptr}, {"-boost", 1, 1, nullptr},
        {"-texres", 1, 1, nullptr}, {"-mm", 1, 2, "the base and gain of a picture are left out"}};
    constexpr map_option word_options[] = {{"-blendu", 1, 1, nullptr}, {"-blendv", 1, 1, nullptr},
        {"-clamp", 1, 1, nullptr}, {"-imfchan", 1, 1, nullptr}, {"-type", 1, 1, nullptr},
        {"-cc", 1, 1, "the colour correction of a picture is left out"},
        {"-colorspace", 1, 1, "the colour space of a picture is that of its file"}};

    template <class Rows>
    auto row_of(const Rows& rows, std::string_view key)
    {
        const auto found = std::find_if(std::begin(rows), std::end(rows), [&](const auto& r) {
            if constexpr (requires { r.key; })
                return r.key == key;
            else if constexpr (requires { r.name; })
                return r.name == key;
            else
                return r == key;
        });
        return found == std::end(rows) ? nullptr : &*found;
    }

    std::string in_small_letters(std::string_view word)
    {
        std::string small(word);
        std::transform(small.begin(), small.end(), small.begin(),
            [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; });
        return small;
    }

    class mtl_parser {
    public:
        mtl_parser(const std::string& file, std::string_view text) : at_(std::make_shared<std::string>(file), text) {}

        std::vector<mtl_material> read()
        {
            while (at_.next_line())
                if (at_.find_word())
                    read_statement();
            return std::move(made_);
        }

    private:
        using mark = statement_reader::mark;

        void note(const mark& place, const std::string& what)
        {
            made_.back().notes.push_back({at_.place_of(place), what});
        }

        void read_statement()
        {
            const auto place = at_.here();
            const auto word = at_.word();
            const auto key = in_small_letters(word);
            if (key == "newmtl") {
                made_.push_back({.name = at_.rest(), .place = at_.place_of(place)});
                return;
            }
            if (made_.empty())
                at_.fail(place, "found " + shown_word(word) + " before the first newmtl");
            auto& m = made_.back();
            if (const auto* c = row_of(colour_keys, key)) {
                if (const auto rgb = colour(place, word))
                    m.*c->to = rgb;
            } else if (const auto* n = row_of(number_keys, key)) {
                if (key == "d" && at_.find_word() && !at_.sees_number())
                    read_halo();
                m.*n->to = at_.number(most, expected_number);
            } else if (const auto* map = row_of(map_keys, key)) {
                m.*map->to = picture(place);
            } else if (key == "illum") {
                const double i = at_.number(most, "the number of an illumination model");
                m.illum = i >= 0 && i <= 10 ? static_cast<int>(i) : 2;
                if (m.illum != i)
                    note(place, "there is no such illumination model; 2 is used");
            } else if (row_of(coat_keys, key) != nullptr) {
                if (at_.number(most, expected_number) != 0)
                    note(place, std::string(word) + " is left out");
            } else if (row_of(ignored_numbers, key) != nullptr) {
                at_.number(most, expected_number);
            } else {
                if (row_of(ignored_keys, key) == nullptr)
                    note(place, shown_word(word) + " is left out");
                at_.rest();
            }
            at_.expect_end();
        }

        /// One number for all channels, or three.
        std::optional<dvec3> colour(const mark& place, std::string_view key)
        {
            bool is_tristimulus = false;
            if (at_.find_word() && !at_.sees_number()) {
                const auto begin = at_.here();
                const auto word = at_.word();
                is_tristimulus = word == "xyz";
                if (word == "spectral") {
                    note(place, std::string(key) + ": a file of a spectrum is left out");
                    at_.rest();
                    return std::nullopt;
                }
                if (!is_tristimulus) {
                    at_.go_back(begin);
                    at_.fail_at_word("one number or three");
                }
            }
            dvec3 c(at_.number(most, "one number or three"));
            if (at_.find_word()) {
                c.y = at_.number(most, "one number or three");
                c.z = at_.number(most, "three numbers");
            }
            return is_tristimulus ? rgb_of_tristimulus(c) : c;
        }
        void read_halo()
        {
            const auto place = at_.here();
            if (at_.word() != "-halo") {
                at_.go_back(place);
                at_.fail_at_word(expected_number);
            }
            note(place, "-halo is left out: the surface is as opaque from all directions");
        }

        /// Of a picture with its options. None for one without a file, with a note.
        std::optional<mtl_map> picture(const mark& place)
        {
            mtl_map map{.file = "", .place = at_.place_of(place)};
            for (;;) {
                if (!at_.find_word())
                    break;
                const auto begin = at_.here();
                const auto word = at_.word();
                if (const auto* of_numbers = row_of(number_options, word)) {
                    read_numbers(begin, *of_numbers, map);
                } else if (const auto* of_word = row_of(word_options, word)) {
                    read_word(begin, *of_word, map);
                } else {
                    at_.go_back(begin);
                    break;
                }
            }
            const auto name = at_.here();
            map.file = at_.rest();
            if (map.file.size() > 1 && map.file.front() == '"' && map.file.back() == '"')
                map.file = map.file.substr(1, map.file.size() - 2);
            if (map.file.starts_with("-") && map.file.find(' ') != std::string::npos)
                at_.fail(name, "found " + shown_word(map.file) + "; expected an option of MTL files or a file's name");
            if (!map.file.empty())
                return map;
            note(place, "a picture without a file is left out");
            return std::nullopt;
        }
        void read_numbers(const mark& place, const map_option& option, mtl_map& map)
        {
            dvec3 v(option.name == "-s" ? 1.0 : 0.0);
            for (int n = 0; n < option.most && (n < option.least || at_.sees_number()); ++n)
                v[n] = at_.number(1e6, "a number up to 10^6");
            if (option.name == "-s")
                map.scale = glm::dvec2(v);
            if (option.name == "-o")
                map.offset = glm::dvec2(v);
            const bool changes = option.name == "-mm" ? v.x != 0 || v.y != 1 : v != dvec3(0);
            if (option.note != nullptr && changes)
                note(place, option.note);
        }
        void read_word(const mark& place, const map_option& option, mtl_map& map)
        {
            if (!at_.find_word())
                at_.fail_at_word("what the option is set to");
            const auto begin = at_.here();
            const auto word = at_.word();
            if (option.name == "-clamp")
                map.clamp = word == "on";
            if (option.name == "-imfchan") {
                constexpr std::string_view channels = "rgbm"; // m: matte
                const auto which = word.size() == 1 ? channels.find(word[0]) : channels.npos;
                if (which != channels.npos)
                    map.channel = static_cast<texture_channel>(which);
                else
                    note(begin, "the channel " + shown_word(word) + " of a picture: red is used");
            }
            if (option.note != nullptr && word != "off")
                note(place, option.note);
        }

        statement_reader at_;
        std::vector<mtl_material> made_;
    };
} // namespace

std::vector<mtl_material> parse_mtl(const std::string& file, std::string_view text)
{
    std::string converted;
    return mtl_parser(file, as_utf8(text, converted)).read();
}

} // namespace photongrid::obj
