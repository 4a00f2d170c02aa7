#include <photongrid/io/import/included_files.hpp>
#include <photongrid/io/mitsuba/xml_file.hpp>
#include <photongrid/io/mitsuba/xml_values.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace photongrid::mitsuba {

namespace {
    constexpr std::size_t max_depth = 64;
    constexpr std::size_t max_objects = std::size_t{1} << 22;
    constexpr std::string_view object_tags[] = {"bsdf", "emitter", "film", "integrator", "medium", "phase", "rfilter",
        "sampler", "sensor", "shape", "spectrum", "subsurface", "texture", "volume"};
    constexpr std::string_view property_tags[] = {"blackbody", "boolean", "float", "integer", "point", "rgb",
        "spectrum", "srgb", "string", "transform", "vector"};
    constexpr std::string_view other_tags[] = {"alias", "default", "include", "path", "ref", "scene"};
    constexpr std::string_view transformation_tags[]
        = {"lookAt", "look_at", "lookat", "matrix", "rotate", "scale", "translate"};

    class parser {
    public:
        parser(const scene_files& files, import_log& log) : files_(files), log_(log) {}

        description read(const std::string& file, std::string_view text)
        {
            const source_file f(std::make_shared<const std::string>(file), text, 0);
            read_file(f, text, nullptr, 0);
            for (const auto& o : made_.objects)
                for (auto& c : o->children)
                    resolve(c);
            return std::move(made_);
        }

    private:
        void resolve(child& c)
        {
            if (c.target != nullptr)
                return;
            const auto found = ids_.find(c.id);
            if (found == ids_.end()) {
                std::vector<std::string> known;
                for (auto i = ids_.begin(); i != ids_.end() && known.size() < 10'000; ++i)
                    known.push_back(i->first);
                fail_at(c.place, "nothing has the id " + shown_word(c.id) + perhaps(c.id, known, "\"", "\""));
            }
            c.target = found->second;
        }

        // --- files ---
        /// `outer`: the object that what an included file has becomes a part of.
        void read_file(source_file f, std::string_view text, object* outer, std::size_t depth)
        {
            if (const auto zero = text.find('\0'); zero != text.npos)
                fail_at(f.place_at(static_cast<std::ptrdiff_t>(zero)), "found a zero byte; expected XML in UTF-8");
            pugi::xml_document document;
            const auto result
                = document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
            if (!result)
                fail_at(f.place_at(std::min(result.offset, static_cast<std::ptrdiff_t>(text.size()))),
                    std::string("this is no XML: ") + result.description());
            const auto root = document.document_element();
            const auto place = f.place_of(root);
            for (auto more = root.next_sibling(); more; more = more.next_sibling())
                if (more.type() == pugi::node_element)
                    fail_at(f.place_of(more),
                        "found " + in_brackets(more.name()) + " behind the end of " + in_brackets(root.name()));
            const bool is_scene = std::string_view(root.name()) == "scene";
            if (outer == nullptr && !is_scene)
                fail_at(place, "found " + in_brackets(root.name()) + "; expected <scene>");
            if (is_scene) {
                check_attributes(f, root, {"version", "type", "id", "name"});
                f.is_old = is_old(f, root, place);
            }
            if (outer == nullptr)
                outer = &add_object(f, root, place);
            if (is_scene)
                read_children(f, root, *outer, depth + 1);
            else
                read_element(f, root, *outer, depth + 1);
        }

        bool is_old(const source_file& f, const pugi::xml_node& root, const source_place& place)
        {
            const std::string version = attribute(f, root, "version");
            const auto number = numbers_of(place, version.substr(0, version.find('.')));
            if (number.size() != 1 || number[0] < 0 || number[0] >= 100)
                fail_at(place, "<scene> lacks a version, such as \"3.0.0\"");
            return number[0] < 2;
        }

        void read_include(const source_file& f, const pugi::xml_node& node, object& outer, std::size_t depth)
        {
            const auto place = f.place_of(node);
            check_attributes(f, node, {"filename"});
            const auto name = attribute(f, node, "filename");
            const auto [path, text] = files_.read(name, place, f.include_depth);
            read_file(
                source_file(std::make_shared<const std::string>(path), text, f.include_depth + 1), text, &outer, depth);
        }

        // --- attributes ---
        /// An attribute's value with those of its parameters; "" if it is missing.
        std::string attribute(const source_file& f, const pugi::xml_node& node, const char* name) const
        {
            return parameters_.replaced(f.place_of(node), node.attribute(name).value());
        }

        std::string required(const source_file& f, const pugi::xml_node& node, const char* name) const
        {
            if (!node.attribute(name))
                fail_at(f.place_of(node), in_brackets(node.name()) + " lacks the attribute \"" + name + "\"");
            return attribute(f, node, name);
        }

        [[noreturn]] static void fail_at_text(const source_file& f, const pugi::xml_node& text)
        {
            fail_at(f.place_of(text), "found the text " + shown_word(text.value()) + "; expected an element");
        }
        static bool is_text(const pugi::xml_node& node)
        {
            return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata;
        }
        /// \throws scene_error for what stands within an element that has attributes alone.
        static void check_empty(const source_file& f, const pugi::xml_node& node)
        {
            for (const auto& c : node.children()) {
                if (is_text(c))
                    fail_at_text(f, c);
                if (c.type() == pugi::node_element)
                    fail_at(f.place_of(c),
                        "found " + in_brackets(c.name()) + " within " + in_brackets(node.name())
                            + "; expected its end");
            }
        }

        // --- elements ---
        void read_children(const source_file& f, const pugi::xml_node& node, object& outer, std::size_t depth)
        {
            if (depth > max_depth)
                fail_at(f.place_of(node), "elements are nested more than 64 deep");
            for (const auto& c : node.children())
                if (c.type() == pugi::node_element)
                    read_element(f, c, outer, depth);
                else if (is_text(c))
                    fail_at_text(f, c);
        }

        void read_element(const source_file& f, const pugi::xml_node& node, object& outer, std::size_t depth)
        {
            const std::string_view tag = node.name();
            if (is_one_of(tag, property_tags) && !(tag == "spectrum" && node.attribute("type")))
                read_property(f, node, outer);
            else if (is_one_of(tag, object_tags))
                read_object(f, node, outer, depth);
            else if (is_one_of(tag, other_tags) && tag != "scene")
                read_other(f, node, outer, depth);
            else
                fail_unknown(f.place_of(node), tag);
        }

        void read_other(const source_file& f, const pugi::xml_node& node, object& outer, std::size_t depth)
        {
            const std::string_view tag = node.name();
            check_empty(f, node);
            if (tag == "ref") {
                read_reference(f, node, outer);
            } else if (tag == "default") {
                read_default(f, node);
            } else if (tag == "include") {
                read_include(f, node, outer, depth);
            } else if (tag == "alias") {
                read_alias(f, node);
            } else {
                check_attributes(f, node, {"value"});
                log_.add(f.place_of(node), "<path>: files are sought in the scene's folder alone");
            }
        }

        [[noreturn]] static void fail_unknown(const source_place& place, std::string_view tag)
        {
            std::vector<std::string> known(std::begin(object_tags), std::end(object_tags));
            known.insert(known.end(), std::begin(property_tags), std::end(property_tags));
            known.insert(known.end(), std::begin(other_tags), std::end(other_tags));
            fail_at(place,
                "found " + in_brackets(tag) + "; expected an element of Mitsuba"
                    + (tag == "scene" ? "" : perhaps(tag, known, "<", ">")));
        }

        object& add_object(const source_file& f, const pugi::xml_node& node, const source_place& place)
        {
            if (made_.objects.size() == max_objects)
                fail_at(place, "there are more than 2^22 objects");
            made_.objects.push_back(std::make_unique<object>(object{.tag = node.name(),
                .type = attribute(f, node, "type"),
                .id = attribute(f, node, "id"),
                .place = place,
                .is_old = f.is_old}));
            auto& o = *made_.objects.back();
            if (!o.id.empty())
                define(o.place, o.id, o);
            return o;
        }

        void define(const source_place& place, const std::string& id, const object& o)
        {
            const auto [found, is_new] = ids_.try_emplace(id, &o);
            if (!is_new)
                fail_at(place,
                    "the id " + shown_word(id) + " is defined twice, in line "
                        + std::to_string(found->second->place.line) + " too");
        }

        void read_object(const source_file& f, const pugi::xml_node& node, object& outer, std::size_t depth)
        {
            const auto place = f.place_of(node);
            check_attributes(f, node, {"type", "id", "name"});
            required(f, node, "type");
            auto& o = add_object(f, node, place);
            add_child(outer, {.name = snake_case(attribute(f, node, "name")), .place = place, .target = &o});
            read_children(f, node, o, depth + 1);
        }

        void read_reference(const source_file& f, const pugi::xml_node& node, object& outer)
        {
            check_attributes(f, node, {"id", "name"});
            add_child(outer,
                {.name = snake_case(attribute(f, node, "name")),
                    .place = f.place_of(node),
                    .id = required(f, node, "id")});
        }

        static void check_name(const source_place& place, const std::string& name, const object& outer)
        {
            const auto has_name = [&](const auto& p) { return p.name == name; };
            // Of the first hundreds: an object has dozens of properties at most, and the time must not grow squarely.
            const auto among = [&](const auto& all) {
                return std::any_of(all.begin(),
                    all.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(all.size(), 500)), has_name);
            };
            if (!name.empty() && (among(outer.properties) || among(outer.children)))
                fail_at(place, outer.said() + " has " + shown_word(name) + " twice");
        }

        static void add_child(object& outer, child c)
        {
            check_name(c.place, c.name, outer);
            outer.children.push_back(std::move(c));
        }

        void read_default(const source_file& f, const pugi::xml_node& node)
        {
            check_attributes(f, node, {"name", "value"});
            parameters_.define(f.place_of(node), required(f, node, "name"), required(f, node, "value"));
        }

        void read_alias(const source_file& f, const pugi::xml_node& node)
        {
            check_attributes(f, node, {"id", "as"});
            const auto found = ids_.find(required(f, node, "id"));
            if (found == ids_.end())
                fail_at(f.place_of(node),
                    "nothing has the id " + shown_word(attribute(f, node, "id")) + " before this <alias>");
            define(f.place_of(node), required(f, node, "as"), *found->second);
        }

        // --- properties ---
        void read_property(const source_file& f, const pugi::xml_node& node, object& outer)
        {
            const element e{.tag = node.name(), .place = f.place_of(node), .attribute = [&](const char* name) {
                                return attribute(f, node, name);
                            }};
            property p{.tag = e.tag, .name = snake_case(required(f, node, "name")), .place = e.place};
            check_name(p.place, p.name, outer);
            read_value(f, node, e, p);
            if (p.is != property_kind::transform)
                check_empty(f, node);
            outer.properties.push_back(std::move(p));
        }

        void read_value(const source_file& f, const pugi::xml_node& node, const element& e, property& p)
        {
            if (e.tag == "transform") {
                p.is = property_kind::transform;
                check_attributes(f, node, {"name"});
                p.matrix = transform_of(f, node);
            } else if (e.tag == "vector" || e.tag == "point") {
                p.is = property_kind::vector;
                check_attributes(f, node, {"name", "value", "x", "y", "z"});
                const auto v = vector_of(e, std::nullopt);
                p.numbers = {v.x, v.y, v.z};
            } else if (e.tag == "rgb" || e.tag == "srgb") {
                p.is = property_kind::color;
                check_attributes(f, node, {"name", "value", "intent"});
                p.numbers = color_of(e);
            } else if (e.tag == "blackbody") {
                p.is = property_kind::blackbody;
                check_attributes(f, node, {"name", "temperature", "scale"});
                auto kelvin = required(f, node, "temperature");
                if (!kelvin.empty() && (kelvin.back() == 'K' || kelvin.back() == 'k'))
                    kelvin.pop_back();
                const auto temperature = numbers_of(e.place, kelvin), scale = numbers_of(e.place, e.attribute("scale"));
                if (temperature.size() != 1 || !(temperature[0] > 0) || scale.size() > 1)
                    fail_at(e.place, "found a blackbody without one temperature, K, above 0");
                p.numbers = {temperature[0], scale.empty() ? 1 : scale[0]};
            } else if (e.tag == "spectrum") {
                read_spectrum(f, node, e, p);
            } else {
                check_attributes(f, node, {"name", "value"});
                read_single(e, required(f, node, "value"), p);
            }
        }

        void read_spectrum(const source_file& f, const pugi::xml_node& node, const element& e, property& p)
        {
            check_attributes(f, node, {"name", "value", "filename", "intent"});
            const auto value = e.attribute("value");
            p.text = e.attribute("filename");
            if (value.empty() == p.text.empty())
                fail_at(e.place, "<spectrum> must have either \"value\" or \"filename\"");
            p.is = property_kind::spectrum;
            if (!p.text.empty())
                return;
            if (value.find(':') != value.npos) {
                p.samples = samples_of(e.place, value);
                return;
            }
            p.is = property_kind::color;
            p.numbers = numbers_of(e.place, value);
            if (p.numbers.size() != 1)
                fail_at(e.place,
                    "found a spectrum of " + std::to_string(p.numbers.size())
                        + " numbers; expected one, or pairs of a wavelength, nm, and a value, as 500:0.6");
            p.numbers.resize(3, p.numbers[0]);
        }

        static void read_single(const element& e, const std::string& value, property& p)
        {
            if (e.tag == "string") {
                p.is = property_kind::text;
                p.text = value;
                return;
            }
            const auto words = words_of(value);
            const auto word = words.size() == 1 ? words[0] : std::string_view();
            if (e.tag == "boolean") {
                p.is = property_kind::truth;
                const auto lower = snake_case(word); // of one word: its small letters
                p.truth = lower == "true";
                if (lower != "true" && lower != "false")
                    fail_at(e.place, "found " + shown_word(value) + "; expected true or false");
                return;
            }
            p.is = e.tag == "integer" ? property_kind::whole : property_kind::number;
            p.numbers = numbers_of(e.place, value);
            if (p.numbers.size() != 1)
                fail_at(e.place, "found " + shown_word(value) + "; expected one number");
            const double most = std::numeric_limits<int>::max();
            if (p.is == property_kind::whole
                && (p.numbers[0] != std::floor(p.numbers[0]) || std::abs(p.numbers[0]) > most))
                fail_at(e.place, "found " + shown_word(value) + "; expected a whole number of up to 2^31 - 1");
        }

        glm::dmat4 transform_of(const source_file& f, const pugi::xml_node& node) const
        {
            glm::dmat4 made(1);
            for (const auto& c : node.children()) {
                if (is_text(c))
                    fail_at_text(f, c);
                if (c.type() != pugi::node_element)
                    continue;
                check_empty(f, c);
                const element e{.tag = c.name(), .place = f.place_of(c), .attribute = [&](const char* name) {
                                    return attribute(f, c, name);
                                }};
                if (!is_one_of(e.tag, transformation_tags))
                    fail_at(e.place,
                        "found " + in_brackets(e.tag) + "; expected translate, scale, rotate, lookat or matrix"
                            + perhaps(e.tag, transformation_tags, "<", ">"));
                if (e.tag == "matrix")
                    check_attributes(f, c, {"value"});
                else if (e.tag == "rotate")
                    check_attributes(f, c, {"angle", "value", "x", "y", "z"});
                else if (e.tag == "translate" || e.tag == "scale")
                    check_attributes(f, c, {"value", "x", "y", "z"});
                else
                    check_attributes(f, c, {"origin", "target", "up"});
                made = transformation_of(e) * made;
            }
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row)
                    if (!std::isfinite(made[column][row]))
                        fail_at(f.place_of(node), "the transformation is not finite");
            return made;
        }

        included_files files_;
        import_log& log_;
        description made_;
        std::map<std::string, const object*, std::less<>> ids_;
        parameter_table parameters_;
    };
} // namespace

description parse(const std::string& file, std::string_view text, const scene_files& files, import_log& log)
{
    return parser(files, log).read(file, text);
}

} // namespace photongrid::mitsuba
