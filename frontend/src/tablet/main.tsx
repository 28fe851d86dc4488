import { mountPage } from "@shared/ui/Page";
import { translations } from "./i18n";
import { keepForOffline } from "./offline/register";
import { Tablet } from "./Tablet";
import "./tablet.css";

mountPage({ translations, children: <Tablet /> });
void keepForOffline();
