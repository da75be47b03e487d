#include "advisor/endpoint_url.h"

#include <gtest/gtest.h>

namespace terra::advisor {
namespace {

TEST(EndpointUrlTest, IsTheSameHoweverTheBaseAddressIsWritten) {
  for (const char* base :
       {"http://127.0.0.1:80", "http://127.0.0.1:80/", "http://127.0.0.1:80/v1",
        "http://127.0.0.1:80/v1/", "http://127.0.0.1:80/v1beta",
        "http://127.0.0.1:80/v1/chat/completions"}) {
    EXPECT_EQ(EndpointUrl(base, "/v1/chat/completions"),
              "http://127.0.0.1:80/v1/chat/completions");
  }
}

TEST(EndpointUrlTest, AFolderBeforeTheVersionStays) {
  for (const char* base : {"https://h/api", "https://h/api/v1/"}) {
    EXPECT_EQ(EndpointUrl(base, "/v1/messages"), "https://h/api/v1/messages");
  }
}

TEST(EndpointUrlTest, AnOtherVersionCountsInsteadOfOurs) {
  EXPECT_EQ(EndpointUrl("https://h/api/v4", "/v1/chat/completions"),
            "https://h/api/v4/chat/completions");
  EXPECT_EQ(EndpointUrl("https://h/v1beta/openai/", "/v1/chat/completions"),
            "https://h/v1beta/openai/chat/completions");
}

TEST(EndpointUrlTest, AHostIsNoVersion) {
  EXPECT_EQ(EndpointUrl("https://v1", "/v1/messages"),
            "https://v1/v1/messages");
  EXPECT_EQ(EndpointUrl("https://v2.example.org/x", "/v1/messages"),
            "https://v2.example.org/x/v1/messages");
}

}  // namespace
}  // namespace terra::advisor
