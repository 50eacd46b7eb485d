#include "program_run.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace shape3d::test {
namespace {

std::string read_all(int descriptor) {
  std::string text;
  char buffer[4096];
  while (true) {
    const ssize_t got = read(descriptor, buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    text.append(buffer, static_cast<std::size_t>(got));
  }
  close(descriptor);
  return text;
}

void limit(int resource, std::uint64_t value) {
  const rlimit limits{value, value};
  if (value != 0) setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

}  // namespace

Run run_shape3d(const std::vector<std::string>& arguments, const RunOptions& options) {
  std::vector<char*> argv{const_cast<char*>(SHAPE3D_PROGRAM)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  int out[2], err[2];
  if (pipe2(out, O_CLOEXEC) != 0 || pipe2(err, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(out[1], STDOUT_FILENO);
    dup2(err[1], STDERR_FILENO);
    if (chdir(options.folder.c_str()) != 0) _exit(126);
    for (const std::string& name : options.unset) unsetenv(name.c_str());
    for (const std::string& pair : options.set) putenv(const_cast<char*>(pair.c_str()));
    limit(RLIMIT_FSIZE, options.file_size_limit);
    limit(RLIMIT_AS, options.memory_limit);
    if (options.user != 0 && (setgid(options.user) != 0 || setuid(options.user) != 0)) _exit(125);
    execv(SHAPE3D_PROGRAM, argv.data());
    _exit(127);
  }
  close(out[1]);
  close(err[1]);
  if (options.while_running) options.while_running(child);
  Run run;
  std::thread errors([&] { run.err = read_all(err[0]); });
  run.out = read_all(out[0]);
  errors.join();
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  run.status = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return run;
}

void make_volume(const std::filesystem::path& header, const std::array<int, 3>& dims,
                 const std::function<float(int, int, int)>& sample,
                 const std::string& header_lines) {
  std::filesystem::path raw = header;
  raw.replace_extension(".raw");
  std::ofstream text(header);
  text << "ObjectType = Image\nNDims = 3\nDimSize = " << dims[0] << ' ' << dims[1] << ' ' << dims[2]
       << '\n';
  text << header_lines;
  if (header_lines.find("ElementSpacing") == std::string::npos) text << "ElementSpacing = 1 1 1\n";
  text << "ElementType = MET_FLOAT\nElementByteOrderMSB = False\nElementDataFile = "
       << raw.filename().string() << '\n';
  std::ofstream data(raw, std::ios::binary);
  for (int k = 0; k < dims[2]; ++k) {
    for (int j = 0; j < dims[1]; ++j) {
      for (int i = 0; i < dims[0]; ++i) {
        const float value = sample(i, j, k);
        data.write(reinterpret_cast<const char*>(&value), sizeof value);
      }
    }
  }
}

std::function<float(int, int, int)> ball(int n, double radius) {
  const double c = 0.5 * (n - 1);
  return [=](int i, int j, int k) {
    return static_cast<float>(radius -
                              std::sqrt((i - c) * (i - c) + (j - c) * (j - c) + (k - c) * (k - c)));
  };
}

std::string slurp(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

nlohmann::json read_json(const std::filesystem::path& path) {
  return nlohmann::json::parse(slurp(path));
}

std::vector<std::string> listing(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace shape3d::test
