#include "base/html.h"

#include <gtest/gtest.h>

namespace terra {
namespace {

TEST(EscapeHtml, LeavesNothingThatEndsATextOrAnAttribute) {
  EXPECT_EQ(EscapeHtml("<a href=\"x\" id='y'>&amp;</a>"),
            "&lt;a href=&quot;x&quot; id=&#39;y&#39;&gt;&amp;amp;&lt;/a&gt;");
}

TEST(EscapeHtml, LeavesAllElseAsItIs) {
  EXPECT_EQ(EscapeHtml("caf\u00e9 10 % \u2013 20 %"),
            "caf\u00e9 10 % \u2013 20 %");
}

}  // namespace
}  // namespace terra
