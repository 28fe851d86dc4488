import "@shared/theme/mantine.css";
import { Notifications } from "@mantine/notifications";
import { mountPage } from "@shared/ui/Page";
import { Console } from "./Console";
import { acceptSearchBehindHash } from "./frame/hashSearch";
import { loaded, translations } from "./i18n";

acceptSearchBehindHash();

const children = (
  <>
    <Notifications position="bottom-right" autoClose={5000} />
    <Console />
  </>
);
// Not `await`: a module that waits at its top would keep the bundler from joining small files.
void loaded.then(() => mountPage({ translations, children }));
