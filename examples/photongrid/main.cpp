// The photongrid program: scene file in, picture and statistics out.
#include "advice.hpp"
#include "command_line.hpp"
#include "convert_command.hpp"
#include "error_command.hpp"
#include "reference_command.hpp"
#include "render_command.hpp"
#include "scene_notes.hpp"
#include "viewer/view_command.hpp"
#include <photongrid/backends/any/any.hpp>
#include <photongrid/compare/image_difference.hpp>
#include <photongrid/compare/picture_noise.hpp>
#include <photongrid/compare/structural_similarity.hpp>
#include <photongrid/io/image_file.hpp>
#include <photongrid/io/tone_map.hpp>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <iostream>
#include <new>
#include <optional>

#include <sys/stat.h>

namespace photongrid {

namespace {
    // --- Ctrl-C ---
    volatile std::sig_atomic_t stop_asked = 0;
    std::time_t stop_time = 0;

    // The first signal requests a stop, which the renderer checks between passes. A second one, seconds later, means
    // that a pass does not end: it ends the process. Output files are always complete, because they are renamed into
    // place.
    extern "C" void ask_to_stop(int)
    {
        timespec now{};
        clock_gettime(CLOCK_MONOTONIC, &now);
        if (stop_asked != 0 && now.tv_sec > stop_time + 1)
            _exit(interrupted);
        if (stop_asked == 0)
            stop_time = now.tv_sec;
        stop_asked = 1;
    }

    void watch_signals()
    {
        struct sigaction action {};
        action.sa_handler = ask_to_stop;
        action.sa_flags = SA_RESTART;
        sigemptyset(&action.sa_mask);
        sigaction(SIGINT, &action, nullptr);
        sigaction(SIGTERM, &action, nullptr);
        // A file beyond `ulimit -f` is then an error of write(), which is reported, and no partial file remains.
        std::signal(SIGXFSZ, SIG_IGN);
    }

    bool asked_to_stop() { return stop_asked != 0; }

    exit_code run(const render_options& o) { return run_render(o, asked_to_stop); }
    exit_code run(const view_options& o) { return run_view(o, asked_to_stop); }
    exit_code run(const reference_options& o) { return run_reference(o, asked_to_stop); }

    exit_code run(const compare_options& o)
    {
        auto a = read_image(o.a), b = read_image(o.b);
        image_difference d;
        std::optional<double> noise;
        const double exposure = exposure_for(b, o.exposure);
        try {
            a = averaged(a, o.average);
            b = averaged(b, o.average);
            d = compare_images(a, b);
            if (!o.again.empty())
                noise = noise_of_two(a, averaged(read_image(o.again), o.average), b);
        } catch (const std::invalid_argument& e) {
            std::cerr << "photongrid: error: " << o.a << ", " << o.b << ": " << e.what() << '\n';
            return file_failure;
        }
        std::cout << "MSE     " << d.mse << "\nrelMSE  " << d.relmse << "\nlargest " << d.largest << " at pixel " << d.x
                  << "," << d.y << "\nSSIM    " << structural_similarity(a, b, exposure) << " at " << exposure
                  << " EV\n";
        if (noise)
            std::cout << "seeds   " << *noise << " of relMSE is noise of " << o.a << '\n';
        if (o.noise)
            std::cout << "noise   " << picture_noise(a) << " and " << picture_noise(b) << ", of each by itself\n";
        if (d.not_finite > 0)
            std::cout << "skipped " << d.not_finite << " pixels that are not finite\n";
        if (d.compared == 0) {
            std::cerr << "photongrid: error: no pixel is finite in both pictures\n";
            return failure;
        }
        return d.relmse > o.max_relmse ? failure : success;
    }

    exit_code run(const check_options& o)
    {
        const auto imported = import_scene(o.scene_path, o.how);
        const auto& s = imported.scene;
        std::cout << o.scene_path << ": " << summary_of(s) << '\n';
        print_notes(std::cout, imported.notes, imported.notes.size());
        for (const auto& odd : oddities(s))
            std::cout << o.scene_path << ": note: " << odd << '\n';
        return success;
    }

    exit_code run(const convert_options& o) { return run_convert(o); }
    exit_code run(const error_options& o) { return run_error(o); }

    exit_code run(const devices_options&)
    {
        for (const auto& d : find_devices()) {
            std::cout << d.backend << "  "
                      << (d.works                   ? d.device
                                 : d.device.empty() ? "not available"
                                                    : d.device + "  not usable")
                      << '\n';
            std::cout << "    " << d.description << '\n';
        }
        return success;
    }

    exit_code run(exit_code answered) { return answered; }
} // namespace

} // namespace photongrid

int main(int argc, char** argv)
{
    using namespace photongrid;
    const auto say = [](const std::exception& e) { std::cerr << "photongrid: error: " << e.what() << '\n'; };
    try {
        watch_signals();
        const auto done = std::visit([](const auto& options) { return run(options); }, read_command_line(argc, argv));
        errno = 0;
        if (!std::cout.flush()) { // a full device, say: what was to be told is lost
            std::cerr << "photongrid: error: the standard output cannot be written"
                      << (errno != 0 ? std::string(": ") + std::strerror(errno) : "") << '\n';
            return done == success ? file_failure : done;
        }
        return done;
    } catch (const render_cancelled&) {
        std::cerr << "photongrid: interrupted; no picture written\n";
        return interrupted;
    } catch (const scene_error& e) {
        std::cerr << e.what() << '\n'; // in compilers' format, so that editors can jump to the line
        return scene_file_error;
    } catch (const backend_error& e) {
        say(e);
        return backend_failure;
    } catch (const file_error& e) {
        say(e);
        return file_failure;
    } catch (const std::bad_alloc&) {
        std::cerr << "photongrid: error: out of memory; fewer photons, pixels or cells need less\n";
        return failure;
    } catch (const std::exception& e) {
        say(e);
        return failure;
    }
}
