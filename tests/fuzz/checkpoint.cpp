// Checkpoints. The input is read as a file, and as the content of a file with a correct head and checksum. An
// accepted checkpoint is written again, and both files are identical in every byte.
#include <polybody/io/checkpoint.hpp>

#include "fuzz/target.hpp"

namespace polybody::fuzz {

void read(std::string_view bytes) {
  std::string const file = folder().put("run.checkpoint", bytes);
  auto const snapshot = accepted([&] { return read_checkpoint(file); },
                                 [&](std::string const& message) { return has(message, "\"" + file + "\""); });
  if (!snapshot) return;
  std::string const again = folder().file("again.checkpoint");
  write_checkpoint(again, *snapshot);
  require(detail::content_of(again) == bytes, "a snapshot that is written is the same file");
}

std::string sealed(std::string_view content) {
  detail::CheckpointHead head = detail::checkpoint_head;
  head.length = content.size();
  std::string all(reinterpret_cast<char const*>(&head), sizeof head);
  all += content;
  std::uint64_t const sum = checksum(all);
  return all.append(reinterpret_cast<char const*>(&sum), sizeof sum);
}

}  // namespace polybody::fuzz

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody::fuzz;
  std::string_view const bytes = text_of(data, size);
  read(bytes);
  read(sealed(bytes));
  return 0;
}
