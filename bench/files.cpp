// How fast scene files are read, and with how much memory: a height field as binary PLY, OBJ and glTF. Each file is
// read in a process of its own. Prints a Markdown table: seconds, the median of three, MB/s, and the largest memory of
// the process over the size of the file. Exits 1 where a limit is not kept.
#include "stopwatch.hpp"
#include "verbs.hpp"

#include <photongrid/io/scene_import.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace photongrid {
namespace {

    /// n x n vertices, and two triangles between each four.
    struct height_field {
        std::uint32_t n;

        glm::vec3 vertex(std::uint32_t row, std::uint32_t column) const
        {
            const float x = static_cast<float>(column), z = static_cast<float>(row), size = static_cast<float>(n);
            return {x / size, 0.1f * std::sin(0.01f * x) * std::sin(0.01f * z), z / size};
        }
        template <class Write>
        void for_each_vertex(const Write& write) const
        {
            for (std::uint32_t row = 0; row < n; ++row)
                for (std::uint32_t column = 0; column < n; ++column)
                    write(vertex(row, column));
        }
        template <class Write>
        void for_each_triangle(const Write& write) const
        {
            for (std::uint32_t row = 0; row + 1 < n; ++row)
                for (std::uint32_t column = 0; column + 1 < n; ++column) {
                    const std::uint32_t first = row * n + column, below = first + n;
                    write(glm::uvec3(first, below, first + 1));
                    write(glm::uvec3(first + 1, below, below + 1));
                }
        }
        std::uint64_t triangles() const { return 2 * std::uint64_t{n - 1} * (n - 1); }
    };

    /// The side of a field whose file has about `megabytes`, with so many bytes for each vertex and its two triangles.
    height_field field_of(double megabytes, double bytes_each)
    {
        return {static_cast<std::uint32_t>(std::max(2.0, std::sqrt(megabytes * 1e6 / bytes_each)))};
    }

    std::uint64_t write_ply(std::FILE* to, double megabytes)
    {
        const auto field = field_of(megabytes, 38);
        std::fprintf(to,
            "ply\nformat binary_little_endian 1.0\nelement vertex %llu\nproperty float x\nproperty float y\n"
            "property float z\nelement face %llu\nproperty list uchar int vertex_indices\nend_header\n",
            static_cast<unsigned long long>(std::uint64_t{field.n} * field.n),
            static_cast<unsigned long long>(field.triangles()));
        field.for_each_vertex([&](const glm::vec3& v) { std::fwrite(&v, sizeof v, 1, to); });
        field.for_each_triangle([&](const glm::uvec3& t) {
            std::fputc(3, to);
            std::fwrite(&t, sizeof t, 1, to);
        });
        return field.triangles();
    }

    std::uint64_t write_obj(std::FILE* to, double megabytes)
    {
        const auto field = field_of(megabytes, 175);
        const auto of = [](float v) { return static_cast<double>(v); };
        field.for_each_vertex(
            [&](const glm::vec3& v) { std::fprintf(to, "v %.6f %.6f %.6f\n", of(v.x), of(v.y), of(v.z)); });
        field.for_each_vertex([&](const glm::vec3& v) { std::fprintf(to, "vt %.6f %.6f\n", of(v.x), of(v.z)); });
        field.for_each_vertex([&](const glm::vec3& v) { std::fprintf(to, "vn %.4f 1.0000 %.4f\n", of(v.y), of(v.y)); });
        field.for_each_triangle([&](const glm::uvec3& t) {
            std::fprintf(to, "f %u/%u/%u %u/%u/%u %u/%u/%u\n", t.x + 1, t.x + 1, t.x + 1, t.y + 1, t.y + 1, t.y + 1,
                t.z + 1, t.z + 1, t.z + 1);
        });
        return field.triangles();
    }

    std::uint64_t write_glb(std::FILE* to, double megabytes)
    {
        const auto field = field_of(megabytes, 36);
        const std::uint64_t vertices = std::uint64_t{field.n} * field.n, positions = 12 * vertices,
                            size = positions + 12 * field.triangles();
        const auto number = [](std::uint64_t n) { return std::to_string(n); };
        auto json = R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": )" + number(size)
            + R"(}], "bufferViews": [{"buffer": 0, "byteLength": )" + number(positions)
            + R"(}, {"buffer": 0, "byteOffset": )" + number(positions) + R"(, "byteLength": )"
            + number(size - positions)
            + R"(}], "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )"
            + number(vertices) + R"(}, {"bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": )"
            + number(3 * field.triangles())
            + R"(}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
              "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]})";
        json.resize((json.size() + 3) / 4 * 4, ' ');
        const auto write = [&](std::uint64_t v) {
            const auto word = static_cast<std::uint32_t>(v);
            std::fwrite(&word, sizeof word, 1, to);
        };
        std::fputs("glTF", to);
        write(2);
        write(28 + json.size() + size);
        write(json.size());
        std::fputs("JSON", to);
        std::fputs(json.c_str(), to);
        write(size);
        std::fwrite("BIN\0", 4, 1, to);
        field.for_each_vertex([&](const glm::vec3& v) { std::fwrite(&v, sizeof v, 1, to); });
        field.for_each_triangle([&](const glm::uvec3& t) { std::fwrite(&t, sizeof t, 1, to); });
        return field.triangles();
    }

    struct reading {
        bool is_good = false;
        double seconds = 0, memory = 0; ///< bytes
    };

    /// Reads a file in a process of its own, whose memory is then known.
    reading read_once(const std::string& path, std::uint64_t triangles)
    {
        int channel[2];
        if (pipe(channel) != 0)
            return {};
        const auto child = fork();
        if (child == 0) {
            bool is_good = false;
            const double seconds = bench::seconds_of([&] {
                const auto made = import_scene(path);
                is_good = made.scene.meshes.size() == 1 && made.scene.meshes[0].surface->triangles.size() == triangles;
            });
            const bool is_told = write(channel[1], &seconds, sizeof seconds) == sizeof seconds;
            _exit(is_good && is_told ? 0 : 1);
        }
        reading r;
        close(channel[1]);
        const bool is_told = read(channel[0], &r.seconds, sizeof r.seconds) == sizeof r.seconds;
        close(channel[0]);
        int status = 1;
        rusage used{};
        r.is_good = wait4(child, &status, 0, &used) == child && status == 0 && is_told;
        r.memory = 1024.0 * static_cast<double>(used.ru_maxrss);
        return r;
    }

    struct format {
        const char *name, *ending;
        std::uint64_t (*write)(std::FILE* to, double megabytes); ///< returns how many triangles it wrote
        double megabytes, max_seconds, max_memory;               ///< the last one over the size of the file
    };

    bool measure(const format& f)
    {
        const auto path = std::filesystem::temp_directory_path()
            / ("photongrid_scene_files_" + std::to_string(getpid()) + f.ending);
        std::FILE* to = std::fopen(path.c_str(), "wb");
        if (to == nullptr)
            return false;
        const auto triangles = f.write(to, f.megabytes);
        std::fclose(to);
        const double size = static_cast<double>(std::filesystem::file_size(path));
        std::vector<double> seconds, memory;
        bool is_good = true;
        for (int repetition = 0; repetition < 3; ++repetition) {
            const auto r = read_once(path.string(), triangles);
            is_good = is_good && r.is_good;
            seconds.push_back(r.seconds);
            memory.push_back(r.memory / size);
        }
        std::filesystem::remove(path);
        const double time = bench::median(seconds), most = bench::median(memory);
        const bool is_kept = time <= f.max_seconds && most <= f.max_memory;
        std::printf("| %s | %.0f | %.2f | %.2f | %.0f | %.2f |%s\n", f.name, size / 1e6,
            static_cast<double>(triangles) / 1e6, time, size / 1e6 / time, most,
            !is_good       ? " not read"
                : !is_kept ? " above its limit"
                           : "");
        return is_good && is_kept;
    }

    int run_files(double ply, double obj, double glb)
    {
        // A process has some 10 MB of its own, which counts where files are small.
        const auto memory = [](double megabytes) { return 3 + 20 / megabytes; };
        const format formats[] = {{"PLY, binary", ".ply", write_ply, ply, 5 * std::max(1.0, ply / 300), memory(ply)},
            {"OBJ", ".obj", write_obj, obj, 5 * std::max(1.0, obj / 100), memory(obj)},
            {"glTF, binary", ".glb", write_glb, glb, 2 * std::max(1.0, glb / 18), 2 + memory(glb)}};
        std::puts("| format | MB | million triangles | s | MB/s | memory over size |");
        std::puts("|---|---|---|---|---|---|");
        bool is_good = true;
        for (const auto& f : formats)
            is_good = measure(f) && is_good;
        return is_good ? 0 : 1;
    }

} // namespace
} // namespace photongrid

photongrid::bench::verb_run photongrid::bench::add_files(CLI::App& verb)
{
    struct megabytes {
        double ply = 300, obj = 100, glb = 18; // a million triangles
    };
    const auto m = std::make_shared<megabytes>();
    verb.add_option("--ply", m->ply, "MB")->check(CLI::PositiveNumber);
    verb.add_option("--obj", m->obj, "MB")->check(CLI::PositiveNumber);
    verb.add_option("--glb", m->glb, "MB")->check(CLI::PositiveNumber);
    return [m] { return run_files(m->ply, m->obj, m->glb); };
}
