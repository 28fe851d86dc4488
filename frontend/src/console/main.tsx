import { mountPage } from "@shared/ui/Page";
import { Console } from "./Console";
import { translations } from "./i18n";

mountPage({ translations, children: <Console /> });
