"""Preloading through a proxy from the environment, as in every program with libcurl."""

import pathlib
import unittest

import servers
from preload_test import PreloadTest
from program import DONE_IN_PART

LEVELS = 3


def environment(proxy, no_proxy=""):
    """The test may run where proxies are set for the whole machine: every spelling is."""
    names = {"http_proxy": proxy, "https_proxy": proxy, "all_proxy": "", "no_proxy": no_proxy}
    return names | {name.upper(): value for name, value in names.items()}


class ThroughAProxy(PreloadTest):
    def setUp(self):
        super().setUp()
        servers.write_pyramid(self.root, LEVELS)
        self.server = self.enterContext(servers.nginx(self.root))
        told = self.enterContext(servers.running(servers.HTTP / "forwarding_proxy.py"))
        self.proxy, self.log = f"http://127.0.0.1:{told['port']}", pathlib.Path(told["log"])

    def asked_proxy(self):
        return self.log.read_text().splitlines()

    def bring(self, template, *options, code=0, **names):
        return self.preload(template, "--levels", f"0-{LEVELS - 1}", *options, code=code,
                            environment=environment(**names))

    def test_every_request_goes_through_it(self):
        summary, _ = self.bring(self.server.template, proxy=self.proxy)
        self.assertEqual(summary["stored"], servers.tiles_in(LEVELS))
        self.assert_stored_are_right()
        address = self.server.template.split("/{z}")[0]
        self.assertEqual(sorted(self.asked_proxy()), sorted(f"GET {address}{path}" for path in self.server.counts()))
        self.assertEqual(len(self.asked_proxy()), servers.tiles_in(LEVELS))

    def test_https_goes_through_a_tunnel(self):
        summary, _ = self.bring(self.server.tls_template, "--ca-file", self.server.ca_file, proxy=self.proxy)
        self.assertEqual(summary["stored"], servers.tiles_in(LEVELS))
        self.assert_stored_are_right()
        host = self.server.tls_template.split("/")[2]
        self.assertEqual(set(self.asked_proxy()), {f"CONNECT {host}"})

    def test_hosts_of_no_proxy_are_asked_directly(self):
        for names in ("127.0.0.1", "other.example,127.0.0.1", "*"):
            with self.subTest(names):
                self.cache = self.folder / f"{len(names)}.gpkg"
                summary, _ = self.bring(self.server.template, proxy=self.proxy, no_proxy=names)
                self.assertEqual(summary["stored"], servers.tiles_in(LEVELS))
                self.assertEqual(self.asked_proxy(), [])

    def test_other_hosts_are_not(self):
        self.bring(self.server.template, proxy=self.proxy, no_proxy="other.example")
        self.assertEqual(len(self.asked_proxy()), servers.tiles_in(LEVELS))

    def test_the_password_of_a_proxy_is_not_told(self):
        _, said = self.bring(self.server.template, "--retries", "0", code=DONE_IN_PART,
                             proxy="http://user:hidden@127.0.0.1:9")
        self.assertNotIn("hidden", said)
        self.assertEqual(self.server.requests(), [])


if __name__ == "__main__":
    unittest.main()
