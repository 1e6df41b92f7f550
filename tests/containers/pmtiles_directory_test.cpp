#include <gtest/gtest.h>
#include <zlib.h>

#include <string>

#include "streaming/pmtiles/pmtiles_format.h"

namespace terrella {
namespace {

std::vector<std::byte> bytes_of(std::initializer_list<int> values) {
  std::vector<std::byte> bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

std::string fault_of(std::initializer_list<int> values) {
  const auto directory = parse_pmtiles_directory(bytes_of(values));
  return directory ? "" : directory.error().message;
}

TEST(PmtilesDirectoryTest, ColumnsDeltasAndOffsetsThatContinue) {
  // Tiles 5, 6 and 300; runs 1, 3, 0; lengths 10, 20, 200; offsets 7, then the end of the entry before, then 0.
  const auto directory = parse_pmtiles_directory(bytes_of({3, 5, 1, 0xA6, 0x02, 1, 3, 0, 10, 20, 0xC8, 0x01, 8, 0, 1}));
  ASSERT_TRUE(directory) << directory.error().message;
  ASSERT_EQ(directory->size(), 3U);
  EXPECT_EQ((*directory)[1].tile, 6U);
  EXPECT_EQ((*directory)[1].offset, 17U);
  EXPECT_EQ((*directory)[2].tile, 300U);
  EXPECT_EQ((*directory)[2].length, 200U);
  EXPECT_EQ((*directory)[2].offset, 0U);
  EXPECT_EQ(find_entry(*directory, 4), nullptr);
  EXPECT_EQ(find_entry(*directory, 8), &(*directory)[1]);
  EXPECT_EQ(find_entry(*directory, 9), nullptr) << "after the run";
  EXPECT_EQ(find_entry(*directory, 1U << 30), &(*directory)[2]) << "a leaf may list any later tile";
}

TEST(PmtilesDirectoryTest, DamageIsNamed) {
  EXPECT_NE(fault_of({}).find("ends"), std::string::npos);
  EXPECT_NE(fault_of({0}).find("lists nothing"), std::string::npos);
  EXPECT_NE(fault_of({2, 1, 0, 1, 1, 1, 1, 1, 1}).find("out of order"), std::string::npos);
  EXPECT_NE(fault_of({2, 1, 1, 2, 1, 1, 1, 1, 1}).find("overlap"), std::string::npos);
  EXPECT_NE(fault_of({1, 1, 1, 0, 1}).find("no bytes"), std::string::npos);
  EXPECT_NE(fault_of({1, 1, 1, 5, 0}).find("continues nothing"), std::string::npos);
  EXPECT_NE(fault_of({1, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x02, 1, 1, 1}).find("too large"),
            std::string::npos);
  EXPECT_NE(fault_of({1, 1, 0xFF, 0xFF, 0xFF, 0xFF, 0x1F, 1, 1}).find("too large"), std::string::npos)
      << "a run of over 32 bits";
}

std::vector<std::byte> gzip_of(const std::vector<std::byte>& bytes) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::vector<std::byte> out(deflateBound(&stream, bytes.size()) + 64);
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(out.size() - stream.avail_out);
  deflateEnd(&stream);
  return out;
}

TEST(PmtilesDirectoryTest, GzipUpToTheLimit) {
  const std::vector<std::byte> bytes(5000, std::byte{7});
  const auto packed = gzip_of(bytes);
  EXPECT_EQ(*unpack(packed, PmtilesCompression::gzip), bytes);
  EXPECT_EQ(*unpack(packed, PmtilesCompression::gzip, 5000), bytes);
  EXPECT_FALSE(unpack(packed, PmtilesCompression::gzip, 4999));
  EXPECT_FALSE(unpack(std::span(packed).first(packed.size() - 9), PmtilesCompression::gzip));
  EXPECT_FALSE(unpack({}, PmtilesCompression::gzip));
  EXPECT_EQ(*unpack(bytes, PmtilesCompression::none), bytes);
}

}  // namespace
}  // namespace terrella
