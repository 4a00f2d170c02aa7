#include "resume_file.hpp"

#include <photongrid/core/fnv1a.hpp>
#include <photongrid/io/scene_writer.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace photongrid {

namespace {
    using json = nlohmann::ordered_json;
    constexpr const char* first_line = "photongrid unfinished picture 7";

    /// The vectors of an unfinished pass, in the file's order.
    template <class Pass>
    auto parts_of(Pass& p)
    {
        std::vector<typename decltype(p.light.parts())::value_type> all;
        for (auto* pixels : {&p.light, &p.band})
            for (auto* part : pixels->parts())
                all.push_back(part);
        return all;
    }

    /// The file's three lines of text, and what follows.
    struct resume_text {
        std::string first_line, identity, head, bytes;
    };
    resume_text split(const std::string& text)
    {
        std::size_t at = 0;
        const auto line = [&] {
            const auto end = std::min(text.find('\n', at), text.size());
            auto l = text.substr(at, end - at);
            at = std::min(end + 1, text.size());
            return l;
        };
        resume_text t;
        for (auto* l : {&t.first_line, &t.identity, &t.head})
            *l = line();
        t.bytes = text.substr(at);
        return t;
    }

    std::string whole_text(const std::string& path)
    {
        std::ifstream file(path, std::ios::binary);
        std::string text{std::istreambuf_iterator<char>(file), {}};
        if (!file.is_open() || file.bad())
            throw file_error(path + ": cannot be read: " + std::strerror(errno));
        return text;
    }

    /// How a file's picture differs from the one that is asked for.
    std::string difference(const std::string& of_file, const std::string& asked)
    {
        const auto a = json::parse(of_file, nullptr, false), b = json::parse(asked);
        for (const auto& [key, value] : b.items()) {
            const bool there = a.is_object() && a.contains(key);
            if (!there || a[key] != value)
                return "was begun with a different " + key
                    + (value.is_string() && there ? " (" + a[key].dump() + ", not " + value.dump() + ")" : "");
        }
        return "was begun by another program";
    }
} // namespace

std::string picture_identity(const scene& s, const render_settings& settings, const capabilities& caps)
{
    // What ends a picture does not change its passes. Whether it may have several does: of one, an eye ray may go
    // through the pixel's middle.
    auto of_passes = settings;
    of_passes.output = settings.output.without_stop_rule();
    of_passes.output.report_bias = output_settings{}.report_bias; // what follows from it is compared below
    const json all = {{"version", PHOTONGRID_VERSION}, {"backend", caps.backend}, {"device", caps.device},
        {"scene", json::parse(scene_text(s, {}))}, {"set of settings", json::parse(settings_text(of_passes))},
        {"choice of layers", settings.output.aov}, {"choice of biases", reports_bias(settings)}};
    return all.dump();
}

void write_resume_file(const std::string& path, const std::string& identity, const render_state& state)
{
    const auto film = state.film.bytes();
    std::string bytes;
    json sizes = json::array();
    for (const auto* part : parts_of(state.pass)) {
        sizes.push_back(part->size());
        bytes.append(reinterpret_cast<const char*>(part->data()), part->size() * sizeof(glm::vec4));
    }
    bytes += film;
    const json head = {{"pass", state.pass.number}, {"rows", state.pass.rows}, {"rays", state.pass.rays},
        {"sizes", sizes}, {"film", film.size()}, {"seconds", state.seconds}, {"hash", detail::fnv1a(identity + bytes)}};
    write_file(path, std::string(first_line) + "\n" + identity + "\n" + head.dump() + "\n" + bytes);
}

std::optional<render_state> read_resume_file(const std::string& path, const std::string& identity)
{
    if (!std::filesystem::exists(path))
        return std::nullopt;
    const auto file = split(whole_text(path));
    const auto fail = [&](const std::string& why) -> void {
        throw file_error(path + ": " + why + "; remove it to begin the picture anew");
    };
    if (file.first_line != first_line)
        fail("is no unfinished picture of this program");
    const auto head = json::parse(file.head, nullptr, false);
    const auto number = [&](const char* key) {
        return head.is_object() && head.contains(key) && head[key].is_number_unsigned() ? head[key].get<std::uint64_t>()
                                                                                        : 0;
    };
    render_state s;
    const auto& bytes = file.bytes;
    const std::size_t film_size = number("film");
    std::size_t size = film_size; // of all parts, in bytes
    for (std::size_t i = 0; auto* part : parts_of(s.pass)) {
        const auto place = json::json_pointer("/sizes/" + std::to_string(i++));
        const bool there = head.is_object() && head.contains(place) && head[place].is_number_unsigned();
        const std::size_t n = there ? head[place].get<std::size_t>() : bytes.size();
        if (film_size > bytes.size() || n > bytes.size() / sizeof(glm::vec4))
            fail("is damaged");
        part->resize(n);
        size += n * sizeof(glm::vec4);
    }
    if (bytes.size() != size || detail::fnv1a(file.identity + bytes) != number("hash"))
        fail("is damaged");
    if (file.identity != identity)
        fail(difference(file.identity, identity));
    s.pass.number = static_cast<std::uint32_t>(number("pass"));
    s.pass.rows = static_cast<std::uint32_t>(number("rows"));
    s.pass.rays = static_cast<std::uint32_t>(number("rays"));
    if (head.contains("seconds") && head["seconds"].is_number())
        s.seconds = head["seconds"].get<double>();
    const char* from = bytes.data();
    for (auto* part : parts_of(s.pass)) {
        if (!part->empty())
            std::memcpy(part->data(), from, part->size() * sizeof(glm::vec4));
        from += part->size() * sizeof(glm::vec4);
    }
    try {
        s.film = film::from_bytes(std::string_view(bytes).substr(bytes.size() - film_size));
    } catch (const std::invalid_argument&) {
        fail("is damaged");
    }
    return s;
}

} // namespace photongrid
